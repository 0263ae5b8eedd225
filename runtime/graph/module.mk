libduite_la_SOURCES += runtime/graph/depend.c runtime/graph/fork.c runtime/graph/graph.c \
	runtime/graph/graph.h runtime/graph/internal.h runtime/graph/resize.c runtime/graph/run.c runtime/graph/set.c \
	runtime/graph/sum.c
