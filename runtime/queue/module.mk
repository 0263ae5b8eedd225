libduite_la_SOURCES += runtime/queue/count.c runtime/queue/park.c runtime/queue/pool.h runtime/queue/queue.c runtime/queue/queue.h
