/* Cores of the machine, and the distances of the workers on them, read at start. To load the
 * topology takes hwloc most of a millisecond, twenty times the rest of a start. So a process loads
 * it once and keeps it.
 *
 * A worker's row has all others, nearest first. Equally near ones begin with the next number, so
 * that not all workers try the same one first. */
#include "runtime/workers/topology.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <errno.h>
#include <hwloc.h>
#include <pthread.h>
#include <sched.h>
#include <string.h>
#include <xxhash.h>

/* ---- Cores ---- */

static pthread_mutex_t topology_lock = PTHREAD_MUTEX_INITIALIZER;
static hwloc_topology_t topology; /* NULL: not loaded; `topology_lock` */

static int topology_refuse(const char *call)
{
    const int reason = errno;
    return base_error(reason == ENOMEM ? DUITE_E_MEMORY : DUITE_E_SYSTEM,
                      "the machine's topology cannot be read: %s: %s", call, strerror(reason));
}

/* The calling thread holds the lock. */
static int topology_load(void)
{
    hwloc_topology_t new;
    if (topology)
        return DUITE_OK;
    if (hwloc_topology_init(&new))
        return topology_refuse("hwloc_topology_init");
    hwloc_topology_set_all_types_filter(new, HWLOC_TYPE_FILTER_KEEP_STRUCTURE);
    hwloc_topology_set_io_types_filter(new, HWLOC_TYPE_FILTER_KEEP_NONE);
    hwloc_topology_set_type_filter(new, HWLOC_OBJ_CORE, HWLOC_TYPE_FILTER_KEEP_ALL);
    if (hwloc_topology_load(new)) {
        const int code = topology_refuse("hwloc_topology_load");
        hwloc_topology_destroy(new);
        return code;
    }
    topology = new;
    return DUITE_OK;
}

__attribute__((destructor)) static void topology_unload(void)
{
    if (topology)
        hwloc_topology_destroy(topology);
}

/* Lists the cores that this process may use now. */
static int cores_list(struct work_cores *cores)
{
    hwloc_bitmap_t allowed = hwloc_bitmap_alloc();
    if (!allowed)
        return base_no_memory("the list of cores");
    if (hwloc_get_cpubind(topology, allowed, HWLOC_CPUBIND_PROCESS))
        hwloc_bitmap_copy(allowed, hwloc_topology_get_allowed_cpuset(topology));
    hwloc_obj_type_t type = HWLOC_OBJ_CORE;
    if (hwloc_get_nbobjs_by_type(topology, type) < 1)
        type = HWLOC_OBJ_PU;
    unsigned max = (unsigned)hwloc_get_nbobjs_by_type(topology, type);
    cores->unit = base_alloc(max * sizeof *cores->unit);
    hwloc_obj_t core = NULL;
    while (cores->unit && (core = hwloc_get_next_obj_by_type(topology, type, core))) {
        hwloc_bitmap_t here = hwloc_bitmap_dup(core->cpuset);
        if (!here)
            continue;
        hwloc_bitmap_and(here, here, allowed);
        int first = hwloc_bitmap_first(here);
        if (first >= 0)
            cores->unit[cores->n++] = first;
        hwloc_bitmap_free(here);
    }
    hwloc_bitmap_free(allowed);
    return cores->unit ? DUITE_OK : base_no_memory("the list of cores");
}

int work_cores_find(struct work_cores *cores)
{
    *cores = (struct work_cores){0};
    pthread_mutex_lock(&topology_lock);
    int code = topology_load();
    if (!code)
        code = cores_list(cores);
    pthread_mutex_unlock(&topology_lock);
    if (!code && !cores->n)
        code = base_error(DUITE_E_SYSTEM, "hwloc finds no core that this process may use");
    if (code)
        work_cores_free(cores);
    else
        cores->hash = XXH64(cores->unit, cores->n * sizeof *cores->unit, 0);
    return code;
}

void work_cores_free(struct work_cores *cores)
{
    base_free(cores->unit);
    *cores = (struct work_cores){0};
}

/* Levels of the topology from unit a up to the smallest part of the machine that has b, too.
 * Returns 0 for the same unit, or if hwloc does not know one. */
static unsigned cores_distance(int a, int b)
{
    unsigned distance = 0;
    pthread_mutex_lock(&topology_lock);
    hwloc_obj_t one = hwloc_get_pu_obj_by_os_index(topology, (unsigned)a),
                other = hwloc_get_pu_obj_by_os_index(topology, (unsigned)b);
    for (; one && other && !hwloc_bitmap_isincluded(other->cpuset, one->cpuset); one = one->parent)
        distance++;
    pthread_mutex_unlock(&topology_lock);
    return one && other ? distance : 0;
}

void work_cores_bind(int unit)
{
    cpu_set_t set;
    if (unit < 0)
        return;
    CPU_ZERO(&set);
    CPU_SET((size_t)unit, &set);
    sched_setaffinity(0, sizeof set, &set);
}

/* ---- Workers and their distances ---- */

/* An insertion sort, which keeps the order of equals. */
static void near_fill_row(struct work_near *near, unsigned worker)
{
    unsigned others = near->n - 1;
    unsigned *row = near->by_nearness + 2 * (size_t)worker * others, *distance = row + others;
    for (unsigned step = 1; step <= others; step++) {
        unsigned other = (worker + step) % near->n, at = step - 1;
        unsigned far = near->distance[worker * near->n + other];
        for (; at && distance[at - 1] > far; at--) {
            row[at] = row[at - 1];
            distance[at] = distance[at - 1];
        }
        row[at] = other;
        distance[at] = far;
    }
    near->of[worker] = (duite_near){.n = others, .worker = row, .distance = distance};
}

bool work_near_start(struct work_near *near, unsigned n, const int *cores)
{
    near->n = n;
    near->distance = base_alloc_zero((size_t)n * n * sizeof *near->distance);
    near->by_nearness = base_alloc_zero(2 * (size_t)n * n * sizeof *near->by_nearness);
    near->of = base_alloc_zero(n * sizeof *near->of);
    if (!near->distance || !near->by_nearness || !near->of)
        return false;
    for (unsigned i = 0; i < n && cores; i++)
        for (unsigned j = 0; j < n; j++)
            near->distance[i * n + j] = cores_distance(cores[i], cores[j]);
    for (unsigned i = 0; i < n; i++)
        near_fill_row(near, i);
    return true;
}

void work_near_stop(struct work_near *near)
{
    base_free(near->distance);
    base_free(near->by_nearness);
    base_free(near->of);
}
