libduite_la_SOURCES += runtime/sched/fifo.c runtime/sched/lifo.c runtime/sched/locality.c runtime/sched/owner.c runtime/sched/priority.c \
	runtime/sched/sched.c runtime/sched/sched.h runtime/sched/shuffle.c runtime/sched/static.c runtime/sched/steal.c
