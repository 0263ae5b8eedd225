libduite_la_SOURCES += runtime/comm/arrivals.c runtime/comm/arrivals.h runtime/comm/ask.c runtime/comm/ask.h \
	runtime/comm/channel.c runtime/comm/channel.h runtime/comm/collective.c runtime/comm/comm.c runtime/comm/comm.h \
	runtime/comm/farewell.c runtime/comm/farewell.h runtime/comm/gauge.h runtime/comm/host.c runtime/comm/host.h \
	runtime/comm/internal.h runtime/comm/heartbeat.c runtime/comm/heartbeat.h runtime/comm/look.c runtime/comm/question.c \
	runtime/comm/question.h runtime/comm/requests.c runtime/comm/requests.h
