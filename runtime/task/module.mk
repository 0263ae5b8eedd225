libduite_la_SOURCES += runtime/task/depend.c runtime/task/fork.c runtime/task/graph.c runtime/task/internal.h runtime/task/move.c runtime/task/nest.c \
	runtime/task/nest.h runtime/task/owner.c runtime/task/owner.h runtime/task/prune.c runtime/task/rename.c runtime/task/resize.c runtime/task/right.c runtime/task/run.c \
	runtime/task/set.c runtime/task/sum.c runtime/task/task.h runtime/task/view.c runtime/task/wait.c 
