# On several hosts, which each test makes of this machine by network namespaces (hosts.sh); skipped where it may not.
check_PROGRAMS += tests/cluster/ranks_traffic
tests_cluster_ranks_traffic_SOURCES = tests/cluster/ranks_traffic.c
tests_cluster_ranks_traffic_LDADD = libduite_core.la
dist_check_SCRIPTS += tests/cluster/hosts.sh tests/cluster/test_hosts.sh
TESTS += tests/cluster/test_hosts.sh
