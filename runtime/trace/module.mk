libduite_la_SOURCES += runtime/trace/call.c runtime/trace/chrome.c runtime/trace/clock.c runtime/trace/csv.c \
	runtime/trace/export.h runtime/trace/file.c runtime/trace/format.h runtime/trace/internal.h runtime/trace/messages.c runtime/trace/paje.c \
	runtime/trace/read.c runtime/trace/read.h runtime/trace/run.c runtime/trace/sums.c runtime/trace/sums.h runtime/trace/trace.h
