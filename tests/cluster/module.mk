# On several hosts, which each test makes of this machine by network namespaces (hosts.sh); skipped where it may not.
PLAIN_SH += tests/cluster/test_hosts.sh tests/cluster/test_same.sh tests/cluster/test_counts.sh tests/cluster/test_faults.sh
LONG_SH += tests/cluster/test_same_long.sh tests/cluster/test_counts_long.sh tests/cluster/test_faults_long.sh \
    tests/cluster/test_predicted_long.sh tests/cluster/test_hidden.sh tests/cluster/test_document.sh tests/cluster/test_slurm.sh
check_PROGRAMS += tests/cluster/ranks_traffic
tests_cluster_ranks_traffic_LDADD = $(CORE_LIBS)
dist_check_SCRIPTS += tests/cluster/hosts.sh
EXTRA_DIST += tests/cluster/cluster.sh
