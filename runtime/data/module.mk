libduite_la_SOURCES += runtime/data/adopted.c runtime/data/adopted.h runtime/data/law.c runtime/data/law.h runtime/data/object.c runtime/data/object.h runtime/data/order.h runtime/data/packet.h \
	runtime/data/subtrees.c runtime/data/subtrees.h runtime/data/sum.c runtime/data/sum.h runtime/data/version.c runtime/data/version.h
