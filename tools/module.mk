# Readers of runs, predictions, charts and comparisons: no part of libduite. Programs link TOOLS_LIBS; a program that draws or reads a chart's options,
# CHART_LIBS before it.
noinst_LIBRARIES += libduite_tools.a
libduite_tools_a_SOURCES =
libduite_tools_a_CPPFLAGS = $(AM_CPPFLAGS) $(CAIRO_CFLAGS)
TOOLS_LIBS = libduite_tools.a $(CORE_LIBS)
CHART_LIBS = libduite_tools.a $(CAIRO_LIBS)

include tools/trace/module.mk
include tools/predict/module.mk
include tools/chart/module.mk
include tools/compare/module.mk

dist_pkgdata_DATA += tools/duite.py
bin_PROGRAMS += duite-trace duite-predict duite-compare duite-graph
dist_man_MANS += tools/duite-trace.1 tools/duite-predict.1 tools/duite-compare.1 tools/duite-graph.1
duite_trace_SOURCES = tools/duite-trace.c tools/command.h
duite_trace_LDADD = $(CHART_LIBS) $(TOOLS_LIBS) $(OTF2_LIBS)
duite_predict_SOURCES = tools/duite-predict.c tools/command.h
duite_predict_LDADD = $(TOOLS_LIBS)
duite_graph_SOURCES = tools/duite-graph.c
duite_graph_LDADD = $(TOOLS_LIBS)
duite_compare_SOURCES = tools/duite-compare.c
duite_compare_LDADD = $(TOOLS_LIBS)
