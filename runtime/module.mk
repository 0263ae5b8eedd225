# libduite for users exports duite_* only. The programs of the tree link libduite_core.a, the same objects with all names.
lib_LTLIBRARIES += libduite.la
noinst_LTLIBRARIES += libduite_core.la
include_HEADERS = runtime/duite.h runtime/duite_policy.h
pkgconfig_DATA = runtime/duite.pc
dist_man_MANS += runtime/duite.3
libduite_la_SOURCES = $(include_HEADERS)
libduite_la_LIBADD = $(METIS_LIBS) $(HWLOC_LIBS) $(XXHASH_LIBS) $(MPI_LIBS) -lm
libduite_la_LDFLAGS = $(AM_LDFLAGS) -version-info 0:0:0 -export-symbols-regex '^duite_'
libduite_core_la_SOURCES = $(libduite_la_SOURCES)
libduite_core_la_LDFLAGS = $(AM_LDFLAGS)
libduite_core.a: libduite_core.la
	$(AM_V_GEN)cp .libs/libduite_core.a $@
CLEANFILES += libduite_core.a
CORE_LIBS = libduite_core.a $(libduite_la_LIBADD)

include runtime/base/module.mk
include runtime/data/module.mk
include runtime/queue/module.mk
include runtime/comm/module.mk
include runtime/task/module.mk
include runtime/plan/module.mk
include runtime/offload/module.mk
include runtime/sched/module.mk
include runtime/map/module.mk
include runtime/balance/module.mk
include runtime/check/module.mk
include runtime/trace/module.mk
include runtime/workers/module.mk
include runtime/api/module.mk
