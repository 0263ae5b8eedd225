libduite_la_SOURCES += runtime/map/cyclic.c runtime/map/hint.c runtime/map/map.h \
	runtime/map/metis.c runtime/map/names.c runtime/map/settle.c
