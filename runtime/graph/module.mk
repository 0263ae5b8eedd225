libduite_la_SOURCES += runtime/graph/away.c runtime/graph/away.h runtime/graph/channel.c runtime/graph/depend.c \
	runtime/graph/fork.c runtime/graph/graph.c runtime/graph/graph.h runtime/graph/guest.c runtime/graph/internal.h \
	runtime/graph/move.c runtime/graph/nest.c runtime/graph/nest.h runtime/graph/parcel.h runtime/graph/print.c runtime/graph/prune.c \
	runtime/graph/record.c runtime/graph/record.h runtime/graph/rename.c runtime/graph/replay.c runtime/graph/replay.h \
	runtime/graph/replay_call.c runtime/graph/replay_draft.c runtime/graph/replay_draft.h runtime/graph/replay_plan.c \
	runtime/graph/replay_ranks.c runtime/graph/resize.c runtime/graph/right.c runtime/graph/run.c runtime/graph/set.c \
	runtime/graph/spread.c runtime/graph/spread.h runtime/graph/spread_local.c runtime/graph/sum.c runtime/graph/tasks.c runtime/graph/view.c \
	runtime/graph/wait.c
