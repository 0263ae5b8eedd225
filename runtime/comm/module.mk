libduite_la_SOURCES += runtime/comm/arrivals.c runtime/comm/arrivals.h runtime/comm/channel.c runtime/comm/channel.h \
	runtime/comm/collective.c runtime/comm/comm.c runtime/comm/comm.h runtime/comm/control.c runtime/comm/control.h \
	runtime/comm/divergence.c runtime/comm/divergence.h runtime/comm/gauge.h runtime/comm/heartbeat.c runtime/comm/heartbeat.h runtime/comm/host.c runtime/comm/host.h \
	runtime/comm/internal.h runtime/comm/link.c runtime/comm/look.c \
	runtime/comm/requests.c runtime/comm/requests.h
