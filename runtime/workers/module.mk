libduite_la_SOURCES += runtime/workers/balance.c runtime/workers/balance.h runtime/workers/main.c runtime/workers/cores.c runtime/workers/cores.h runtime/workers/count.c runtime/workers/deque.c \
	runtime/workers/deque.h runtime/workers/hooks.c runtime/workers/heap.c runtime/workers/heap.h runtime/workers/inside.c runtime/workers/internal.h runtime/workers/park.c runtime/workers/park.h runtime/workers/queue.c \
	runtime/workers/queue.h runtime/workers/tell.c runtime/workers/watch.c runtime/workers/watch.h runtime/workers/workers.c runtime/workers/workers.h
