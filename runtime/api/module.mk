libduite_la_SOURCES += runtime/api/acquire.c runtime/api/agree.c runtime/api/bodies.c runtime/api/graphs.c runtime/api/instance.h runtime/api/migrate.c \
	runtime/api/objects.c runtime/api/parts.c \
	runtime/api/options.c runtime/api/program.c runtime/api/report.c runtime/api/start.c runtime/api/trace.c runtime/api/wait.c runtime/api/wait_for.c
