libduite_la_SOURCES += runtime/offload/message.h runtime/offload/offload.h runtime/offload/receive.c \
	runtime/offload/send.c
