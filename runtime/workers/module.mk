libduite_la_SOURCES += runtime/workers/balance.c runtime/workers/balance.h runtime/workers/deque.c runtime/workers/deque.h runtime/workers/dispatch.c runtime/workers/heap.c runtime/workers/heap.h \
	runtime/workers/idle.c runtime/workers/inside.c runtime/workers/internal.h runtime/workers/main.c runtime/workers/park.c runtime/workers/park.h runtime/workers/pool.c \
	runtime/workers/queue.c runtime/workers/queue.h runtime/workers/report.c runtime/workers/cost.c runtime/workers/cost.h runtime/workers/standstill.c runtime/workers/standstill.h runtime/workers/topology.c \
	runtime/workers/topology.h runtime/workers/worker.c runtime/workers/workers.h
