libduite_cloth_a_SOURCES += \
	cloth/base/axes.c cloth/base/axes.h cloth/base/bytes.h cloth/base/clock.h \
	cloth/base/error.c cloth/base/error.h \
	cloth/base/file.c cloth/base/file.h \
	cloth/base/memory.c cloth/base/memory.h cloth/base/number.c cloth/base/number.h cloth/base/order.h cloth/base/sets.h \
	cloth/base/simd.c cloth/base/simd.h \
	cloth/base/thread.h cloth/base/vector.h
