libduite_tools_a_SOURCES += tools/predict/bounds.c tools/predict/export.c tools/predict/fork.c tools/predict/graph.c tools/predict/graph.h tools/predict/machine.c \
	tools/predict/machine.h tools/predict/move.c tools/predict/network.c tools/predict/network.h tools/predict/objects.c tools/predict/part.c tools/predict/platform.c tools/predict/platform.h tools/predict/predict.c tools/predict/predict.h \
	tools/predict/program.c tools/predict/program.h tools/predict/record.c tools/predict/replay.c tools/predict/round.c tools/predict/simulate.c \
	tools/predict/sum.c tools/predict/times.c tools/predict/value.c
