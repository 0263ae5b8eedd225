libduite_la_SOURCES += runtime/map/blocks.c runtime/map/blocks.h runtime/map/list.c runtime/map/map.c runtime/map/map.h \
	runtime/map/metis.c runtime/map/settle.c runtime/map/taskgraph.c runtime/map/tasks.c
