libduite_la_SOURCES += runtime/map/block.c runtime/map/blocks.c runtime/map/blocks.h runtime/map/cyclic.c runtime/map/list.c \
	runtime/map/map.h runtime/map/metis.c runtime/map/map.c runtime/map/random.c runtime/map/settle.c runtime/map/taskgraph.c \
	runtime/map/tasks.c runtime/map/tasks.h
