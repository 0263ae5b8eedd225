# Predictions of traced runs: no part of libduite. Programs that predict link it before libduite_core.
noinst_LIBRARIES += libduite_predict.a
libduite_predict_a_SOURCES = runtime/predict/bounds.c runtime/predict/export.c runtime/predict/graph.c runtime/predict/graph.h runtime/predict/machine.c \
	runtime/predict/machine.h runtime/predict/move.c runtime/predict/objects.c runtime/predict/predict.c runtime/predict/predict.h \
	runtime/predict/program.c runtime/predict/program.h runtime/predict/replay.c runtime/predict/round.c runtime/predict/simulate.c \
	runtime/predict/sum.c runtime/predict/times.c
PREDICT_LIBS = libduite_predict.a $(CORE_LIBS)

bin_PROGRAMS += duite-trace
dist_man_MANS += runtime/predict/duite-trace.1
duite_trace_SOURCES = runtime/predict/duite-trace.c runtime/predict/command.h
duite_trace_LDADD = $(CHART_LIBS) $(PREDICT_LIBS)
bin_PROGRAMS += duite-predict
dist_man_MANS += runtime/predict/duite-predict.1
duite_predict_SOURCES = runtime/predict/duite-predict.c runtime/predict/command.h
duite_predict_LDADD = $(PREDICT_LIBS)
