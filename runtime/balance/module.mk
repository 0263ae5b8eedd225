libduite_la_SOURCES += runtime/balance/balance.h runtime/balance/balance.c runtime/balance/none.c runtime/balance/delegate.c runtime/balance/scatter.c
