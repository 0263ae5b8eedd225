libduite_la_SOURCES += runtime/check/check.c runtime/check/check.h
