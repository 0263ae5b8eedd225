libduite_la_SOURCES += runtime/sched/sched.c runtime/sched/sched.h
