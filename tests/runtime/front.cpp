// duite.hpp: each of its calls, with errors as exceptions and, by DUITE_NO_EXCEPTIONS, as codes. Prints what is wrong.

#include <duite.hpp>

#include <cstdio>
#include <cstring>
#include <thread>

namespace {

int wrong;

#define CHECK(condition)                                                                                                                 \
    do {                                                                                                                                 \
        if (!(condition)) {                                                                                                              \
            std::printf("line %d: %s\n", __LINE__, #condition);                                                                          \
            wrong++;                                                                                                                     \
        }                                                                                                                                \
    } while (0)

struct point {
    float x, y, z;
};

// The longer of two points, a law of the program.
double length2(const point &p) { return double(p.x) * p.x + double(p.y) * p.y + double(p.z) * p.z; }
void keep_longer(void *left, const void *right, std::size_t bytes, duite_type)
{
    auto *a = static_cast<point *>(left);
    const auto *b = static_cast<const point *>(right);
    for (std::size_t i = 0; i < bytes / sizeof *a; i++)
        if (length2(b[i]) > length2(a[i]))
            a[i] = b[i];
}
const duite_law LONGER = {"longer", DUITE_BYTE, nullptr, keep_longer};

const duite::kernel FILL("fill", [](int from, duite::write<std::int64_t> x) {
    for (std::int64_t &each : x)
        each = from++;
});
const duite::kernel ADD("add", [](duite::read<std::int64_t> x, duite::sum<std::int64_t> sum) {
    for (std::int64_t each : x)
        sum[0] += each;
});
const duite::kernel TWICE("twice", [](duite::readwrite<std::int64_t> x) noexcept {
    for (std::int64_t &each : x)
        each *= 2;
});
const duite::kernel ALL("all", [](duite::write<std::int64_t> to, duite::rest<duite::read<std::int64_t>> from) {
    for (std::size_t i = 0; i < to.size(); i++) {
        to[i] = 0;
        for (std::size_t j = 0; j < from.size(); j++)
            to[i] += from[j][i];
    }
});
const duite::kernel OFFER("offer", [](const point &p, duite::accumulate<point, LONGER> longest) { longest[0] = p; });
const duite::kernel SHORTEN("shorten", [](std::uint32_t n, duite::write<point> p) {
    if (p.size() != p.max())
        return 9;
    for (std::size_t i = 0; i < p.size(); i++)
        p[i] = {float(i), 0, 0};
    return p.resize(n);
});
const duite::kernel FAIL("fail", [](duite::task &here, duite::write<std::int64_t>) { return here.fail(17, "as it should"); });
const duite::kernel LATER("later", [](duite::task &here, int code, duite::write<std::int64_t> x) {
    const duite::event event = here.make_event();
    std::int64_t *value = x.data();
    std::thread([=] { // the data stay in place until the event
        *value = 5;
        event.complete(code);
    }).detach();
}, duite::events);

// Fibonacci by tasks that leave their result to children.
const duite::kernel PLUS("plus", [](duite::read<std::int64_t> a, duite::read<std::int64_t> b, duite::write<std::int64_t> to) { to[0] = a[0] + b[0]; });
int fib(duite::task &here, int n, const duite::ref<std::int64_t> &to);
const duite::kernel FIB("fib", [](duite::task &here, int n, duite::postponed<duite::write<std::int64_t>> to) { return fib(here, n, to); });
int fib(duite::task &here, int n, const duite::ref<std::int64_t> &to)
{
    if (n < 2)
        return here.fork(FILL, n, to);
    duite::object<std::int64_t> a(here, 1), b(here, 1);
    here.fork(FIB, n - 1, a);
    here.fork(FIB, n - 2, b);
    return here.fork(PLUS, a, b, to);
}
// The same by waiting, and as a contribution of the body itself.
const duite::kernel WAITING("waiting", [](duite::task &here, int n, duite::postponed<duite::sum<std::int64_t>> to) {
    duite::object<std::int64_t> part(here, 1);
    std::int64_t value = 0;
    here.fork(FIB, n, part);
    const int code = here.get(part, value);
    if (!code)
        to.contribute()[0] = value;
    return code;
});

void values(duite::runtime &rt)
{
    duite::object<std::int64_t> x(rt, 10), sum(rt, 1), y(rt, 10);
    std::vector<std::int64_t> got;
    std::int64_t total = 0;
    CHECK(rt.fork(FILL, 3, x) == DUITE_OK);
    rt.fork(ADD, x, sum);
    rt.fork(TWICE, x);
    duite_task_options urgent{};
    urgent.priority = 3;
    rt.fork_with(urgent, ADD, x, sum);
    CHECK(rt.get(sum, total) == DUITE_OK && total == 3 * 75);
    CHECK(rt.get(x, got) == DUITE_OK && got.size() == 10 && got[9] == 24);
    rt.set(y, got);
    rt.set(sum, 7);
    rt.get(sum, total);
    CHECK(total == 7);
    const std::vector<duite::ref<std::int64_t>> both = {x, y};
    duite::object<std::int64_t> to(rt, 10);
    rt.fork(ALL, to, both);
    rt.get(to, got);
    CHECK(got[0] == 12);
    duite::object<std::int64_t> moved(std::move(to));
    x = std::move(moved); // frees the old x, once it goes
    rt.get(x, got);
    CHECK(got[9] == 48);
    rt.fork(FIB, 10, sum);
    rt.fork(WAITING, 10, sum);
    rt.get(sum, total);
    CHECK(total == 2 * 55);
}

void structures(duite::runtime &rt)
{
    duite::object<point> longest(rt, 1), some(rt, 0, 8);
    std::vector<point> points;
    for (int i = 0; i < 5; i++)
        rt.fork(OFFER, point{0, float(i % 3), 0}, longest);
    point p{};
    rt.get(longest, p);
    CHECK(p.y == 2);
    rt.fork(SHORTEN, 3u, some);
    rt.get(some, points);
    CHECK(points.size() == 3 && points[2].x == 2);
    rt.set(some, duite::span<const point>(points.data(), 2));
    {
        auto turn = rt.acquire(some);
        for (point &each : turn)
            each.z = 4;
    }
    rt.get(some, points);
    CHECK(points.size() == 2 && points[1].z == 4);
}

void turns(duite::runtime &rt)
{
    duite::object<std::int64_t> x(rt, 4);
    const bool home = duite_home(rt.c(), x.name) == duite_rank(rt.c());
    std::int64_t first = 0;
    {
        auto turn = rt.acquire_write(x);
        CHECK(turn.code() == DUITE_OK && turn.size() == (home ? 4u : 0u));
        for (std::int64_t &each : turn)
            each = 21;
        rt.fork(TWICE, x); // waits for the end of the turn
    }
    auto turn = rt.acquire_read(x);
    CHECK(!home || turn[3] == 42);
    CHECK(turn.release() == DUITE_OK && turn.size() == 0 && turn.release() == DUITE_OK);
    rt.fork(FAIL, x);
    {
        auto poisoned = rt.acquire(x);
        CHECK(poisoned.code() == (home ? 17 : 0) && poisoned.size() == 0);
    }
    CHECK(duite_wait(rt.c()) == 17 && std::strstr(duite_message(), "as it should"));
    rt.set(x, std::vector<std::int64_t>(4, 1));
    CHECK(rt.get(x, first) == DUITE_OK && first == 1);
}

void parts(duite::runtime &rt)
{
    duite::object<point> p(rt, 3);
    duite::object<std::int64_t> x(rt, 5);
    std::vector<std::int64_t> got;
    const std::vector<duite::ref<std::int64_t>> two = rt.split(x, {2, 3});
    rt.fork(FILL, 1, two[0]);
    rt.fork(FILL, 10, two[1]);
    rt.fork(TWICE, two[1]);
    CHECK(rt.join(x) == DUITE_OK);
    rt.get(x, got);
    CHECK((got == std::vector<std::int64_t>{1, 2, 20, 22, 24}));
    const auto each = rt.split(p, {1, 2}); // structures, too
    rt.set(each[1], std::vector<point>(2, point{1, 2, 3}));
    rt.join(p);
    std::vector<point> all;
    rt.get(p, all);
    CHECK(all[0].y == 0 && all[1].y == 2 && all[2].z == 3);
}

void adopted(duite::runtime &rt)
{
    std::vector<std::int64_t> mine(3, 4), got;
    {
        duite::object<std::int64_t> x(rt, 0, 3, duite_rank(rt.c()) == 0 ? mine.data() : nullptr);
        rt.fork(TWICE, x);
        rt.get(x, got);
        CHECK(got == std::vector<std::int64_t>(3, 8));
    }
    rt.wait();
    CHECK(mine[2] == (duite_rank(rt.c()) == 0 ? 8 : 4));
}

void events(duite::runtime &rt)
{
    duite::object<std::int64_t> x(rt, 1);
    std::int64_t value = 0;
    rt.fork(LATER, 0, x);
    rt.get(x, value);
    CHECK(value == 5);
}

// Waits for some objects; requests of MPI of the body's own; a kernel that is added.
const duite::kernel SELF("self", [](duite::task &here, duite::write<std::int64_t> x) {
    static std::int64_t sent;
    MPI_Request requests[2];
    sent = 77;
    duite_mpi_begin(here.c());
    MPI_Irecv(x.data(), 1, MPI_INT64_T, 0, 5, MPI_COMM_SELF, &requests[0]);
    MPI_Isend(&sent, 1, MPI_INT64_T, 0, 5, MPI_COMM_SELF, &requests[1]);
    duite_mpi_end(here.c());
    return here.await_mpi(requests);
}, duite::events);

void later(duite::runtime &rt)
{
    duite::object<std::int64_t> x(rt, 4), y(rt, 1);
    std::int64_t value = 0;
    CHECK(rt.add(SELF.c()) == DUITE_OK);
    rt.fork(SELF, y);
    rt.fork(FILL, 6, x);
    CHECK(rt.wait_for(x, y) == DUITE_OK && rt.test(x) && rt.test(x, y));
    rt.get(y, value);
    CHECK(value == 77);
}

void graphs(duite::runtime &rt)
{
    duite::object<std::int64_t> x(rt, 1), y(rt, 1), sum(rt, 1);
    std::int64_t value = 0;
    std::uint64_t rounds = 0;
    rt.set(sum, 0);
    duite::graph graph(rt, [&] {
        rt.fork(FILL, 1, x);
        rt.fork(ADD, x, sum);
    });
    CHECK(graph.replay(4) == DUITE_OK);
    graph.args(0, 10);
    graph.replay();
    rt.set(y, 100);
    graph.bind(x, y);
    graph.replay();
    rt.get(sum, value);
    CHECK(value == 4 + 10 + 10);
    rt.get(y, value);
    CHECK(value == 10);
    duite::graph moved(std::move(graph));
    moved.replay_while(sum, 3);
    CHECK(moved.rounds(rounds) == DUITE_OK && rounds == 3);
}

#ifdef DUITE_NO_EXCEPTIONS
void errors(duite::runtime &rt)
{
    duite::object<std::int64_t> x(rt, 4), none(rt, 0); // no elements: remembered
    std::vector<std::int64_t> got;
    CHECK(duite_wait(rt.c()) == DUITE_E_ARGUMENT);
    rt.fork(FAIL, x);
    CHECK(rt.get(x, got) == 17 && rt.wait() == 17);
    CHECK(rt.set(x, std::vector<std::int64_t>(3)) == DUITE_E_SIZE && rt.wait() == DUITE_E_SIZE);
    duite::graph graph(rt, [&] { rt.set(x, std::vector<std::int64_t>(3)); });
    CHECK(graph.replay() == DUITE_E_OBJECT && rt.wait() == DUITE_E_SIZE);
    duite::runtime second(ADD); // MPI is for one at a time
    CHECK(!second && second.fork(TWICE, x) == DUITE_E_ARGUMENT);
}
#else
template <typename F> int thrown(F call)
{
    try {
        call();
    } catch (const duite::error &failure) {
        return failure.code();
    }
    return 0;
}
const duite::kernel THROW("throw", [](duite::write<std::int64_t>) { throw std::runtime_error("thrown by the body"); });
const duite::kernel OWN("own", [](duite::write<std::int64_t>) { throw duite::error(31, "with a code"); });
const duite::kernel PASS("pass", [](duite::task &here, duite::write<std::int64_t>) {
    duite::object<std::int64_t> mine(here, 1);
    here.fork(FAIL, mine);
    here.get(mine); // throws on
});

void errors(duite::runtime &rt)
{
    duite::object<std::int64_t> x(rt, 4);
    rt.fork(FAIL, x);
    CHECK(thrown([&] { rt.get(x); }) == 17 && thrown([&] { rt.wait(); }) == 17);
    rt.fork(THROW, x);
    CHECK(thrown([&] { rt.wait(); }) == 1 && std::strstr(duite_message(), "thrown by the body"));
    rt.fork(OWN, x);
    CHECK(thrown([&] { rt.wait(); }) == 31 && std::strstr(duite_message(), "with a code"));
    rt.fork(PASS, x);
    CHECK(thrown([&] { rt.get(x); }) == 17 && thrown([&] { rt.wait(); }) == 17);
    CHECK(thrown([] { duite::runtime second(ADD); }) == DUITE_E_STATE); // MPI is for one at a time
    rt.fork(LATER, 23, x);
    CHECK(thrown([&] { rt.wait(); }) == 23);
    CHECK(thrown([&] { rt.set(x, std::vector<std::int64_t>(3)); }) == DUITE_E_SIZE && thrown([&] { rt.wait(); }) == DUITE_E_SIZE);
    CHECK(thrown([&] { duite::object<double>(rt, 0); }) == DUITE_E_ARGUMENT && thrown([&] { rt.wait(); }) == DUITE_E_ARGUMENT);
    int caught = 0;
    try {
        duite::graph graph(rt, [] { throw 5; });
    } catch (int number) {
        caught = number;
    }
    CHECK(caught == 5 && thrown([&] { rt.wait(); }) == 1);
    duite_free(rt.c(), x.name); // so the destructor's fails, and says it later
    {
        duite::object<std::int64_t> gone(std::move(x));
    }
    CHECK(thrown([&] { rt.wait(); }) == DUITE_E_OBJECT);
}
#endif

} // namespace

int main()
{
    duite::options options;
    options.window = 1000;
#ifdef DUITE_NO_EXCEPTIONS
    duite::runtime rt(options, FILL, ADD, TWICE, ALL, OFFER, SHORTEN, FAIL, LATER, PLUS, FIB, WAITING);
#else
    duite::runtime rt(options, FILL, ADD, TWICE, ALL, OFFER, SHORTEN, FAIL, LATER, PLUS, FIB, WAITING, THROW, OWN, PASS);
#endif
    if (!rt) {
        std::printf("%s\n", duite_message());
        return 1;
    }
    duite::object<double> late(rt, 1); // does not mind that the runtime stops first
    values(rt);
    structures(rt);
    turns(rt);
    parts(rt);
    adopted(rt);
    events(rt);
    later(rt);
    graphs(rt);
    errors(rt);
#ifdef DUITE_NO_EXCEPTIONS
    CHECK(rt.stop() == DUITE_E_NOT_FREED && !rt);
#else
    CHECK(thrown([&] { rt.stop(); }) == DUITE_E_NOT_FREED && !rt);
#endif
    return wrong != 0;
}
