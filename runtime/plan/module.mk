libduite_la_SOURCES += runtime/plan/assign.c runtime/plan/channel.c runtime/plan/channel.h runtime/plan/edges.c runtime/plan/emit.c \
	runtime/plan/lower.c \
	runtime/plan/memo.c runtime/plan/memo.h runtime/plan/memo_round.c runtime/plan/memo_round.h runtime/plan/open.c \
	runtime/plan/messages.c runtime/plan/node.h runtime/plan/part.c runtime/plan/part.h runtime/plan/part_sums.c runtime/plan/passes.h \
	runtime/plan/pieces.c runtime/plan/plan.h runtime/plan/ranks.c \
	runtime/plan/record.c runtime/plan/record.h runtime/plan/relay.c runtime/plan/replay_call.c runtime/plan/run.c \
	runtime/plan/tasks.c
