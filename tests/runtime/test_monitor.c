/* The monitor's looks, and its reports where nobody reads them. */
#include "runtime/base/error.h"
#include "runtime/base/monitor.h"
#include "tests/support/unit.h"

#include <dirent.h>
#include <duite.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum { MOST_WAITS = 120000 };

static void pause_for(double seconds)
{
    nanosleep(&(struct timespec){.tv_nsec = (long)(1e9 * seconds)}, NULL);
}

struct looked {
    _Atomic int times;
    int refuses; /* so many looks could not be made */
};

static bool count(void *context)
{
    struct looked *looked = context;
    atomic_fetch_add(&looked->times, 1);
    return looked->refuses-- <= 0;
}

static void await(const struct looked *looked, int times)
{
    for (int i = 0; i < MOST_WAITS && atomic_load(&looked->times) < times; i++)
        pause_for(1e-3);
    ck_assert_int_ge(atomic_load(&looked->times), times);
}

static int threads(void)
{
    int n = 0;
    DIR *folder = opendir("/proc/self/task");
    for (const struct dirent *entry; (entry = readdir(folder));)
        n += entry->d_name[0] != '.';
    closedir(folder);
    return n;
}

/* A thread that was joined is still listed for a moment. */
static void await_threads(int n)
{
    for (int i = 0; i < MOST_WAITS && threads() != n; i++)
        pause_for(1e-3);
    ck_assert_int_eq(threads(), n);
}

static void *nothing(void *context)
{
    return context;
}

/* How many threads there are, that which a sanitizer starts beside the first one of ours among
 * them. */
static int threads_before(void)
{
    pthread_t first;
    ck_assert_int_eq(pthread_create(&first, NULL, nothing, NULL), 0);
    ck_assert_int_eq(pthread_join(first, NULL), 0);
    int n = threads(), again = 0;
    for (int same = 0; same < 50; same = again == n ? same + 1 : 0, n = again) {
        pause_for(1e-3);
        again = threads();
    }
    return n;
}

/* One thread, from the first look on until the last one is removed. */
UNIT_TEST(looks)
{
    struct base_monitor monitor = {0};
    struct looked often = {0}, seldom = {0}, later = {0}, refused = {.refuses = 5};
    struct base_look a = {.look = count, .context = &often, .seconds = 1e-3},
                     b = {.look = count, .context = &seldom, .seconds = 3600},
                     c = {.look = count, .context = &later, .seconds = 3600},
                     d = {.look = count, .context = &refused, .seconds = 0.01};
    struct base_look *const all[] = {&a, &b, &c, &d};
    const int before = threads_before();

    base_monitor_remove(&monitor, &a); /* was not added */
    for (int round = 0; round < 2; round++) {
        for (int i = 0; i < 4; i++)
            ck_assert_int_eq(base_monitor_add(&monitor, all[i]), DUITE_OK);
        await_threads(before + 1);
        await(&often, 20);
        await(&refused, 6);
        ck_assert_int_eq(seldom.times, 0);
        base_monitor_set_period(&monitor, &c, 1e-3);
        await(&later, 3);
        base_monitor_remove(&monitor, &a);
        atomic_store(&often.times, 0);
        atomic_store(&later.times, 0);
        await(&later, 20);
        ck_assert_int_eq(often.times, 0);
        for (int i = 1; i < 4; i++)
            base_monitor_remove(&monitor, all[i]);
        await_threads(before);
        ck_assert_ptr_null(monitor.looks);
        c.seconds = 3600;
    }
}

/* A report returns although nobody reads standard error, a pipe or a socket; and comes whole where
 * somebody does. */
UNIT_LOOP(blocked_report, 0, 2)
{
    char text[200] = "";
    int end[2], before = dup(STDERR_FILENO);
    ck_assert(!(_i ? socketpair(AF_UNIX, SOCK_STREAM, 0, end) : pipe(end)));
    dup2(end[1], STDERR_FILENO);
    base_report("all of it");
    ck_assert_int_eq(read(end[0], text, sizeof text), 9);
    fcntl(end[1], F_SETFL, O_NONBLOCK);
    while (write(end[1], text, sizeof text) > 0)
        ;
    while (write(end[1], text, 1) > 0)
        ;
    fcntl(end[1], F_SETFL, 0);
    base_report("nobody reads this");
    const int flags = fcntl(end[1], F_GETFL);
    dup2(before, STDERR_FILENO);
    ck_assert(!(flags & O_NONBLOCK));
    ck_assert_str_eq(text, "all of it");
}
