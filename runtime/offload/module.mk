libduite_la_SOURCES += runtime/offload/message.h runtime/offload/names.c runtime/offload/names.h runtime/offload/offload.h runtime/offload/receive.c \
	runtime/offload/send.c
