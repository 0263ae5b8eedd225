# duite-bench and its rivals: built by `make bench`, and for its test by `make check`; never installed. The two OpenMP
# rivals are one source for two compilers, without the flags of the build, which may be another compiler's; no rival is
# built with sanitizers.
BENCH_RIVALS =
BENCH_STATE = bench/cg/state.c bench/cg/state.h
BENCH_SHARED = bench/problem.c bench/problem.h bench/serve.c bench/serve.h
check_LIBRARIES += bench/libbench.a
bench_libbench_a_SOURCES = bench/bench.h bench/instructions.c bench/instructions.h \
	bench/loops.c bench/loops.h bench/measure.c bench/measure.h bench/temporary.c bench/temporary.h \
	bench/program.c bench/program.h bench/report.c bench/report.h bench/subject.c bench/subject.h \
	bench/tasks/tasks.c bench/tasks/tasks.h bench/tasks/adopt.c bench/tasks/bytes.c bench/tasks/chain.c bench/tasks/event.c bench/tasks/fib.c bench/tasks/fib.h bench/tasks/forks.c bench/forks.h \
	bench/tasks/growth.c bench/tasks/independent.c bench/tasks/instructions.c \
	bench/tasks/stencil.c bench/tasks/tiles.c bench/tasks/tree.c bench/tasks/wake.c bench/tiles.h \
	bench/ranks/await.c bench/ranks/cg.c bench/ranks/delegate.c bench/ranks/forks.c bench/ranks/loaded.c bench/ranks/memory.c \
	bench/ranks/migrate.c bench/ranks/ranks.c bench/ranks/ranks.h bench/ranks/sheet.c bench/ranks/sheet.h bench/ranks/stencil.c bench/ranks/tree.c bench/ranks/twin.c \
	bench/cg/bench.c bench/cg/cg.h bench/cg/frames.c bench/cg/make.c bench/cg/ours.c bench/cg/plans.c bench/cg/search.c bench/cg/solution.c bench/cg/states.c bench/cg/touch.c bench/sets.h \
	bench/contact/bench.c bench/contact/blender.c bench/contact/certify.c bench/contact/contact.h bench/contact/detect.c bench/contact/instructions.c \
	bench/contact/maps.c \
	bench/contact/plans.c bench/contact/scene.c bench/contact/shapes.c bench/contact/shapes.h bench/contact/solid.c bench/contact/state.c \
	cloth/app/check/intersections.c cloth/app/check/intersections.h \
	bench/garments/avatar.c bench/garments/bench.c bench/garments/correction.c tests/support/skinned.c tests/support/skinned.h bench/garments/scenes.c bench/garments/worn.c bench/garments/garments.h \
	bench/output/bench.c bench/output/folder.h bench/output/output.h bench/output/run.c bench/output/viewer.c bench/output/viewer.h \
	bench/physics/bench.c bench/physics/ours.c bench/physics/physics.h \
	bench/predict/bench.c bench/predict/errors.c bench/predict/many.c bench/predict/order.c bench/predict/overhead.c bench/predict/predict.h bench/predict/quota.c \
	bench/predict/sheet.c bench/scale/coarse.c bench/scale/messages.c bench/scale/predicted.c bench/scale/runs.c bench/scale/scale.c bench/scale/scale.h \
	tests/support/trace_file.c tests/support/trace_file.h \
	$(BENCH_STATE) $(BENCH_SHARED)
bench_libbench_a_CPPFLAGS = $(AM_CPPFLAGS) -DBENCH_MPIRUN='"$(MPIRUN)"' -DBENCH_CFLAGS='"$(CFLAGS)"' \
	-DBENCH_HOSTS='"$(abs_top_srcdir)/tests/cluster/hosts.sh"' \
	-DBENCH_BLENDER='"$(abs_top_srcdir)/bench/rivals/blender_sphere.py"' \
	-DBENCH_VIEW_MISSING='"$(VIEW_MISSING)"' \
	-DBENCH_SCENES='"$(abs_top_srcdir)/cloth/scenes"' \
	-DBENCH_PEERS='"$(abs_top_srcdir)/bench/contact/peers"' \
	-DBENCH_STATES_SCENE='"$(abs_top_srcdir)/bench/cg/states.yaml"' \
	-DBENCH_WORN_SCENE='"$(abs_top_srcdir)/bench/garments/worn.yaml"' \
	-DBENCH_HANGING_SCENE='"$(abs_top_srcdir)/bench/garments/hanging.yaml"' \
	-DBENCH_PATTERNS='"$(abs_top_srcdir)/../shared/data/patterns"' \
	-DBENCH_OWN_PATTERNS='"$(abs_top_srcdir)/tests/cloth/garment/patterns"' \
	-DBENCH_DRESS='"$(abs_top_srcdir)/../shared/data/meshes/dress-v17k-f34k.obj"'
check_PROGRAMS += bench/duite-bench
bench_duite_bench_SOURCES = bench/duite-bench.c
bench_duite_bench_LDADD = $(BENCH_LIBRARY)
EXTRA_DIST += bench/experiments bench/readme.sh bench/contact/peers bench/garments/experiments.sh bench/fabrics/experiments.sh bench/fabrics/sheet.awk bench/fabrics/strip.awk bench/garments/hanging.yaml bench/garments/worn.yaml \
	bench/vassilev/panels.awk bench/vassilev/jeans.yaml bench/rivals/blender_sphere.py bench/rivals/openmp.c bench/rivals/openmp_forks.c bench/rivals/openmp_graph.c bench/rivals/forks.cpp bench/rivals/openmp.h bench/cg/states.yaml bench/tiles.c \
	bench/results/epyc-2026-11-22.md bench/results/epyc-2026-11-30.md bench/results/epyc-2026-12-01.md \
	bench/results/xeon-2026-11-27.md bench/results/xeon-2026-11-29.md

# The arithmetic of tiles and of what forks, which would otherwise compare compilers: compiled once, for us and the rivals. The rivals in
# C++ have all that they share with the others so.
ARITHMETIC = bench/rivals/tiles.$(OBJEXT) bench/rivals/forks.$(OBJEXT)
FORKS_OBJECTS = bench/rivals/forks.$(OBJEXT) bench/rivals/problem.$(OBJEXT) bench/rivals/serve.$(OBJEXT)
$(ARITHMETIC) bench/rivals/problem.$(OBJEXT) bench/rivals/serve.$(OBJEXT): bench/tiles.c bench/tiles.h bench/forks.c bench/forks.h $(BENCH_SHARED)
	$(AM_V_CC)$(MKDIR_P) bench/rivals && $(CC) -std=gnu17 -O2 -fPIE $(WARN_CFLAGS) -D_GNU_SOURCE -I$(srcdir) -c -o $@ \
	$(srcdir)/bench/`basename $@ .$(OBJEXT)`.c
CLEANFILES += $(ARITHMETIC) bench/rivals/problem.$(OBJEXT) bench/rivals/serve.$(OBJEXT)
# Linked by programs that use libbench.
BENCH_LIBRARY = bench/libbench.a $(ARITHMETIC) libduite_tools.a $(CLOTH_LIBS)

OPENMP_FILES = bench/rivals/openmp.c bench/rivals/openmp_forks.c bench/problem.c bench/serve.c
OPENMP_NEEDS = $(OPENMP_FILES) bench/forks.h bench/problem.h bench/rivals/openmp.h bench/serve.h bench/tiles.h $(ARITHMETIC)
TWIN_FILES = bench/rivals/twin.c tools/compare/graph.c
TWIN_SHARED = $(TWIN_FILES) bench/rivals/twin.h tools/compare/body.h tools/compare/graph.h
OPENMP_COMPILE = $(MKDIR_P) bench/rivals && compile() { files=$$1; compiler=$$2; settings=$$3; shift 3; sources=; \
	for source in $$files; do sources="$$sources $(srcdir)/$$source"; done; \
	$$compiler -std=gnu17 -O2 $(WARN_CFLAGS) -D_GNU_SOURCE -I$(srcdir) -I$(srcdir)/runtime $(MPI_CFLAGS) \
	-DRIVAL_SETTINGS="\"$$settings\"" "$$@" $$sources -lm; } && compile
OPENMP_GRAPH = bench/rivals/openmp_graph.c $(TWIN_FILES)
bench/rivals/libgomp$(EXEEXT): $(OPENMP_NEEDS)
	$(AM_V_CC)$(OPENMP_COMPILE) '$(OPENMP_FILES)' '$(RIVAL_GCC)' "OpenMP tasks, -O2, `$(RIVAL_GCC) --version | head -n 1`" -fopenmp -o $@ $(ARITHMETIC)
bench/rivals/libomp$(EXEEXT): $(OPENMP_NEEDS)
	$(AM_V_CC)$(OPENMP_COMPILE) '$(OPENMP_FILES)' '$(RIVAL_CLANG)' "OpenMP tasks, -O2, `$(RIVAL_CLANG) --version | head -n 1`" -fopenmp=libomp -o $@ $(ARITHMETIC)
bench/rivals/libgomp-graph$(EXEEXT): bench/rivals/openmp_graph.c $(TWIN_SHARED)
	$(AM_V_CC)$(OPENMP_COMPILE) '$(OPENMP_GRAPH)' '$(RIVAL_GCC)' libgomp-graph -fopenmp -o $@
bench/rivals/libomp-graph$(EXEEXT): bench/rivals/openmp_graph.c $(TWIN_SHARED)
	$(AM_V_CC)$(OPENMP_COMPILE) '$(OPENMP_GRAPH)' '$(RIVAL_CLANG)' libomp-graph -fopenmp=libomp -o $@
LIBGOMP_RIVALS = bench/rivals/libgomp$(EXEEXT) bench/rivals/libgomp-graph$(EXEEXT)
LIBOMP_RIVALS = bench/rivals/libomp$(EXEEXT) bench/rivals/libomp-graph$(EXEEXT)
CLEANFILES += $(LIBGOMP_RIVALS) $(LIBOMP_RIVALS)
if HAVE_RIVAL_LIBGOMP
BENCH_RIVALS += $(LIBGOMP_RIVALS)
endif
if HAVE_RIVAL_LIBOMP
BENCH_RIVALS += $(LIBOMP_RIVALS)
endif

# The two in C++ are one source.
FORKS_COMPILE = compile() { $(CXX) -std=c++20 -O2 -Wall -Wextra -I$(srcdir) $(srcdir)/bench/rivals/forks.cpp $(FORKS_OBJECTS) \
	-DRIVAL_SETTINGS="\"$$1, -O2, `$(CXX) --version | head -n 1`\"" -o $@ $$2; } && compile
bench/rivals/tbb$(EXEEXT): bench/rivals/forks.cpp $(FORKS_OBJECTS)
	$(AM_V_CC)$(FORKS_COMPILE) oneTBB -ltbb
bench/rivals/taskflow$(EXEEXT): bench/rivals/forks.cpp $(FORKS_OBJECTS)
	$(AM_V_CC)$(FORKS_COMPILE) Taskflow '-DRIVAL_TASKFLOW $(TASKFLOW_CPPFLAGS) -pthread'
CLEANFILES += bench/rivals/tbb$(EXEEXT) bench/rivals/taskflow$(EXEEXT)
if HAVE_RIVAL_TBB
BENCH_RIVALS += bench/rivals/tbb$(EXEEXT)
endif
if HAVE_RIVAL_TASKFLOW
BENCH_RIVALS += bench/rivals/taskflow$(EXEEXT)
endif

RIVAL_CFLAGS = -std=gnu17 $(WARN_CFLAGS)
if HAVE_RIVAL_STARPU
check_PROGRAMS += bench/rivals/starpu
BENCH_RIVALS += bench/rivals/starpu$(EXEEXT)
bench_rivals_starpu_SOURCES = bench/rivals/starpu.c $(BENCH_SHARED)
bench_rivals_starpu_CPPFLAGS = $(AM_CPPFLAGS) $(STARPU_CFLAGS)
bench_rivals_starpu_CFLAGS = $(RIVAL_CFLAGS)
bench_rivals_starpu_LDFLAGS =
bench_rivals_starpu_LDADD = $(STARPU_LIBS)
check_PROGRAMS += bench/rivals/starpu-graph
BENCH_RIVALS += bench/rivals/starpu-graph$(EXEEXT)
bench_rivals_starpu_graph_SOURCES = bench/rivals/starpu_graph.c $(TWIN_SHARED)
bench_rivals_starpu_graph_CPPFLAGS = $(AM_CPPFLAGS) $(STARPU_CFLAGS)
bench_rivals_starpu_graph_CFLAGS = $(RIVAL_CFLAGS)
bench_rivals_starpu_graph_LDFLAGS =
bench_rivals_starpu_graph_LDADD = $(STARPU_LIBS) -lm
endif
if HAVE_RIVAL_MPI
check_PROGRAMS += bench/rivals/mpi
BENCH_RIVALS += bench/rivals/mpi$(EXEEXT)
bench_rivals_mpi_SOURCES = bench/rivals/mpi.c $(BENCH_SHARED)
bench_rivals_mpi_CFLAGS = $(RIVAL_CFLAGS)
bench_rivals_mpi_LDFLAGS =
bench_rivals_mpi_LDADD = $(MPI_LIBS)
check_PROGRAMS += bench/rivals/mpi-graph
BENCH_RIVALS += bench/rivals/mpi-graph$(EXEEXT)
bench_rivals_mpi_graph_SOURCES = bench/rivals/mpi_graph.c $(TWIN_SHARED) bench/serve.c bench/serve.h
bench_rivals_mpi_graph_CFLAGS = $(RIVAL_CFLAGS)
bench_rivals_mpi_graph_LDFLAGS =
bench_rivals_mpi_graph_LDADD = $(MPI_LIBS) -lm
endif

# Ours as Task Bench's own programs have others.
if HAVE_TASKBENCH
check_PROGRAMS += bench/rivals/taskbench
BENCH_RIVALS += bench/rivals/taskbench$(EXEEXT)
bench_rivals_taskbench_SOURCES = bench/rivals/taskbench.c
bench_rivals_taskbench_CPPFLAGS = $(AM_CPPFLAGS) -isystem $(TASKBENCH_CORE)
bench_rivals_taskbench_LDFLAGS = $(AM_LDFLAGS) -no-install
bench_rivals_taskbench_LDADD = $(TASKBENCH_CORE)/libcore.a libduite.la $(MPI_LIBS) -lstdc++ -lm
endif

# The reader of states; with the cloth's own kernels, but without sanitizers.
RIVAL_STATE = $(BENCH_STATE) bench/serve.c bench/serve.h cloth/base/error.c cloth/base/error.h cloth/solve/system.c \
	cloth/solve/system.h
if HAVE_RIVAL_OPENMP
check_PROGRAMS += bench/cg/twin
BENCH_RIVALS += bench/cg/twin$(EXEEXT)
bench_cg_twin_SOURCES = bench/cg/twin.c bench/cg/parts.c bench/cg/parts.h cloth/solve/block.c cloth/solve/block.h \
	cloth/solve/cg.c cloth/solve/cg.h cloth/physics/vec.h cloth/base/simd.c cloth/base/simd.h $(RIVAL_STATE)
bench_cg_twin_CFLAGS = $(RIVAL_CFLAGS) -ffp-contract=off $(OPENMP_CFLAGS)
bench_cg_twin_LDFLAGS =
bench_cg_twin_LDADD = -lm
endif
if HAVE_RIVAL_PETSC
check_PROGRAMS += bench/rivals/petsc
BENCH_RIVALS += bench/rivals/petsc$(EXEEXT)
bench_rivals_petsc_SOURCES = bench/rivals/petsc.c bench/rivals/petsc_system.c bench/rivals/petsc_system.h $(RIVAL_STATE)
bench_rivals_petsc_CPPFLAGS = $(AM_CPPFLAGS) $(PETSC_CFLAGS)
bench_rivals_petsc_CFLAGS = $(RIVAL_CFLAGS)
bench_rivals_petsc_LDFLAGS =
bench_rivals_petsc_LDADD = $(PETSC_LIBS) $(MPI_LIBS) -lm
endif

if HAVE_RIVAL_EMBREE
check_PROGRAMS += bench/rivals/embree
BENCH_RIVALS += bench/rivals/embree$(EXEEXT)
bench_rivals_embree_SOURCES = bench/rivals/embree.c bench/contact/shapes.c bench/contact/shapes.h bench/serve.c bench/serve.h
bench_rivals_embree_CFLAGS = $(RIVAL_CFLAGS)
bench_rivals_embree_LDFLAGS =
bench_rivals_embree_LDADD = -lembree3 -lm
endif

# The program that draws for `duite-bench output`.
if HAVE_VIEW
check_PROGRAMS += bench/output/draw
BENCH_RIVALS += bench/output/draw$(EXEEXT)
bench_output_draw_SOURCES = bench/output/draw.c bench/output/folder.h bench/serve.c bench/serve.h
bench_output_draw_LDADD = $(VIEW_LIBS)
endif

# The program whose instructions `duite-bench tasks` counts: with the library of users, not with libduite_core.
check_PROGRAMS += bench/tasks/counted
bench_tasks_counted_SOURCES = bench/tasks/counted.c bench/problem.c bench/problem.h bench/tasks/fib.h
bench_tasks_counted_LDFLAGS = $(AM_LDFLAGS) -no-install
bench_tasks_counted_LDADD = libduite.la

# The program of bench/experiments contact-partition.
check_PROGRAMS += bench/contact-partition
bench_contact_partition_SOURCES = bench/contact/partition.c
bench_contact_partition_LDADD = $(BENCH_LIBRARY)

# The six loops that bench/experiments vassilev runs.
check_PROGRAMS += bench/vassilev/vassilev
bench_vassilev_vassilev_SOURCES = bench/vassilev/vassilev.c bench/vassilev/loops.c bench/vassilev/loops.h bench/vassilev/repel.c \
	bench/vassilev/take.c bench/serve.c bench/serve.h
bench_vassilev_vassilev_LDADD = $(CLOTH_LIBS)

# After all else, of which it runs programs, too: two makes side by side would write the same files.
bench: all
	@$(MAKE) $(AM_MAKEFLAGS) bench-programs
bench-programs: bench/tasks/counted$(EXEEXT) bench/vassilev/vassilev$(EXEEXT) bench/contact-partition$(EXEEXT) bench/duite-bench$(EXEEXT) \
	$(BENCH_RIVALS)
check_DATA += $(BENCH_RIVALS)
