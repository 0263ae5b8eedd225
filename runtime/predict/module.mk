libduite_la_SOURCES += runtime/predict/conclude.c runtime/predict/dot.c runtime/predict/file.c runtime/predict/graph.c runtime/predict/graph.h runtime/predict/machine.c runtime/predict/machine.h \
	runtime/predict/move.c runtime/predict/objects.c runtime/predict/packet.c runtime/predict/predict.c runtime/predict/predict.h runtime/predict/program.c runtime/predict/program.h \
	runtime/predict/replay.c runtime/predict/round.c runtime/predict/simulate.c runtime/predict/times.c
