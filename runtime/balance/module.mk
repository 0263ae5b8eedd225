libduite_la_SOURCES += runtime/balance/balance.h runtime/balance/balance.c runtime/balance/migrate.c \
	runtime/balance/refine.c runtime/balance/refine.h
