# Sourced by run.sh and tap.sh: what Open MPI and hwloc are to do where tests run. The user's own settings win. MPICH does without: its mpirun
# counts no slots, binds nothing and starts as root. So a test calls mpirun with -n alone; `is_openmpi` is for what only Open MPI can do.
# Where the size of files is limited, UCX_TLS=self spares a process alone the shared memory of MPICH, which is 4 MiB.

if test "$(id -u)" = 0; then
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none
# Ranks that wait inside MPI let others run: where other programs run too, starts and stops take twenty times as long else.
export OMPI_MCA_mpi_yield_when_idle=1
# One machine's shared memory is enough: without a look for network cards, and a daemon for a program without mpirun, a
# start takes a tenth of the time.
export OMPI_MCA_pml="${OMPI_MCA_pml:-ob1}" OMPI_MCA_btl="${OMPI_MCA_btl:-^ofi,openib}" OMPI_MCA_ess_singleton_isolated=1
# mpirun ends a job of which a rank failed at once, not after a second.
export OMPI_MCA_odls_base_sigkill_timeout="${OMPI_MCA_odls_base_sigkill_timeout:-0}"
is_openmpi() { case $("${MPIRUN:-mpirun}" --version 2> /dev/null) in *"Open MPI"* | *OpenRTE*) ;; *) false ;; esac; }
# A user's general settings for programs of duite are not tested or measured.
unset DUITE_SCHEDULER DUITE_MAPPING DUITE_BALANCE DUITE_THREADS DUITE_SEED DUITE_TRACE
# hwloc: silent about caches that a virtual machine reports wrongly, and no look for graphics cards on ten X displays, which
# takes seconds at each start where localhost has no name.
export HWLOC_HIDE_ERRORS=2 HWLOC_COMPONENTS="${HWLOC_COMPONENTS:--gl}"
