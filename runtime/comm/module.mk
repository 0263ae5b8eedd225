libduite_la_SOURCES += runtime/comm/arrivals.c runtime/comm/channel.c runtime/comm/collective.c \
	runtime/comm/comm.c runtime/comm/comm.h runtime/comm/control.c runtime/comm/control.h runtime/comm/difference.c \
	runtime/comm/divergence.c runtime/comm/guests.c runtime/comm/guests.h runtime/comm/heartbeat.c runtime/comm/history.h \
	runtime/comm/hosts.c runtime/comm/internal.h runtime/comm/message.h runtime/comm/requests.c runtime/comm/tags.c runtime/comm/transport.c \
	runtime/comm/verdict.c
