libduite_la_SOURCES += runtime/comm/arrivals.c runtime/comm/arrivals.h runtime/comm/comm.c \
	runtime/comm/comm.h runtime/comm/host.c runtime/comm/host.h
