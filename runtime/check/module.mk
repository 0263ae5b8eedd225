libduite_la_SOURCES += runtime/check/check.c runtime/check/check.h runtime/check/region.c runtime/check/region.h
