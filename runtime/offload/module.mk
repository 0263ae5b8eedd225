libduite_la_SOURCES += runtime/offload/away.c runtime/offload/away.h runtime/offload/guest.c runtime/offload/parcel.h 
