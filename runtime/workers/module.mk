libduite_la_SOURCES += runtime/workers/await.c runtime/workers/balance.c runtime/workers/cost.c runtime/workers/cost.h runtime/workers/dispatch.c runtime/workers/idle.c \
	runtime/workers/internal.h runtime/workers/pool.c runtime/workers/queue.c runtime/workers/queue.h \
	runtime/workers/run.c runtime/workers/share.c runtime/workers/share.h runtime/workers/standstill.c \
	runtime/workers/topology.c runtime/workers/topology.h runtime/workers/wait.c runtime/workers/worker.c runtime/workers/workers.h
# An exception that leaves a body comes by there.
runtime/workers/run.lo: AM_CFLAGS += -fexceptions
