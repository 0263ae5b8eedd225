libduite_la_SOURCES += runtime/duite.c runtime/instance.h runtime/program.c
