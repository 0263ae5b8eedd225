libduite_tools_a_SOURCES += tools/trace/chrome.c tools/trace/csv.c tools/trace/export.h tools/trace/messages.c tools/trace/moments.c tools/trace/otf2.c tools/trace/paje.c \
	tools/trace/read.c tools/trace/read.h tools/trace/run.c tools/trace/sums.c tools/trace/sums.h
