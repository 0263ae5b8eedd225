libduite_la_SOURCES += runtime/base/clock.c runtime/base/clock.h runtime/base/error.c runtime/base/error.h runtime/base/heap.h \
	runtime/base/memory.c runtime/base/memory.h runtime/base/monitor.c runtime/base/monitor.h runtime/base/policy.c runtime/base/policy.h \
	runtime/base/rank_set.h runtime/base/stack.h runtime/base/thread.c runtime/base/thread.h
