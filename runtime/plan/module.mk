libduite_la_SOURCES += runtime/plan/channel.c runtime/plan/edges.c runtime/plan/emit.c runtime/plan/local.c runtime/plan/lower.c \
	runtime/plan/passes.h runtime/plan/print.c runtime/plan/ranks.c runtime/plan/record.c runtime/plan/record.h runtime/plan/replay.c \
	runtime/plan/replay.h runtime/plan/replay_call.c runtime/plan/source.c runtime/plan/spread.c runtime/plan/spread.h runtime/plan/tasks.c
