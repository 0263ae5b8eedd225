libduite_la_SOURCES += runtime/queue/pool.c runtime/queue/pool.h runtime/queue/queue.c runtime/queue/queue.h
