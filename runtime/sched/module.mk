libduite_la_SOURCES += runtime/sched/fifo.c runtime/sched/sched.c runtime/sched/sched.h \
	runtime/sched/shuffle.c runtime/sched/steal.c
