# The journal's words about the build, and the command that starts ranks.
libduite_tools_a_CPPFLAGS += -DCOMPARE_MPIRUN='"$(MPIRUN)"' -DCOMPARE_CFLAGS='"$(CFLAGS)"' -DCOMPARE_SOURCE='"$(top_srcdir)"'
libduite_tools_a_SOURCES += tools/compare/body.h tools/compare/compare.h tools/compare/environment.h tools/compare/figure.c tools/compare/figure.h tools/compare/graph.c tools/compare/graph.h \
	tools/compare/journal.c tools/compare/load.c tools/compare/load.h tools/compare/median.c tools/compare/metg.c tools/compare/page.c tools/compare/plot.c tools/compare/plot.h \
	tools/compare/plots.c tools/compare/program.c \
	tools/compare/program.h tools/compare/runs.c tools/compare/start.c tools/compare/statistics.c \
	tools/compare/table.c tools/compare/traced.c
