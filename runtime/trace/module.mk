libduite_la_SOURCES += runtime/trace/call.c runtime/trace/clock.c runtime/trace/file.c runtime/trace/format.h runtime/trace/internal.h \
	runtime/trace/trace.h
