libduite_la_SOURCES += runtime/task/access.h runtime/task/adopt.c runtime/task/away.c runtime/task/body.h runtime/task/call.h runtime/task/check.c runtime/task/contribute.c runtime/task/depend.c runtime/task/event.c runtime/task/event.h \
	runtime/task/fingerprint.h runtime/task/finish.c runtime/task/fork.c runtime/task/fork.h runtime/task/graph.c runtime/task/kernels.c \
	runtime/task/internal.h runtime/task/message.c runtime/task/objects.c runtime/task/owner.h runtime/task/parts.c runtime/task/parts.h runtime/task/place.c \
	runtime/task/ready.h runtime/task/reduce.c runtime/task/run.c runtime/task/scope.c runtime/task/scope.h runtime/task/scope_end.c runtime/task/task.h
