// Heat on a ring of blocks, in C++17 by duite.hpp: a round is recorded once and replayed, each time with new arguments, until the
// largest change is small. Compared with a plain loop, to the last bit.

#include <duite.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

namespace {

constexpr std::size_t BLOCKS = 7, LENGTH = 60, N = BLOCKS * LENGTH;
constexpr int MOST = 400;

struct heat {
    double speed;
};

double step(const heat &by, double left, double here, double right) { return here + by.speed * (left - 2 * here + right); }

// Kernels say by their parameters what a task does with its objects.
const duite::kernel SPREAD("spread", [](const heat &by, duite::read<double> left, duite::read<double> here, duite::read<double> right,
                                        duite::write<double> next, duite::max<double> change) {
    const std::size_t n = here.size();
    for (std::size_t i = 0; i < n; i++) {
        next[i] = step(by, i ? here[i - 1] : left[n - 1], here[i], i + 1 < n ? here[i + 1] : right[0]);
        change[0] = std::fmax(change[0], std::fabs(next[i] - here[i]));
    }
});
const duite::kernel JUDGE(
    "judge", [](duite::read<double> change, duite::write<std::int32_t> more) { more[0] = change[0] > 1e-4; }, duite::replicated);

// Rounds until nothing changes any more, by a plain loop.
int plain(std::vector<double> &x, const heat &by)
{
    std::vector<double> next(N);
    double change = 1;
    int rounds = 0;
    for (; change > 1e-4 && rounds < MOST; rounds++) {
        change = 0;
        for (std::size_t i = 0; i < N; i++) {
            next[i] = step(by, x[(i + N - 1) % N], x[i], x[(i + 1) % N]);
            change = std::fmax(change, std::fabs(next[i] - x[i]));
        }
        x.swap(next);
    }
    return rounds;
}

bool run(duite::runtime &rt)
{
    std::vector<duite::object<double>> from, to;
    for (std::size_t b = 0; b < BLOCKS; b++) {
        from.emplace_back(rt, LENGTH);
        to.emplace_back(rt, LENGTH);
        duite_colocate(rt.c(), to[b].name, from[b].name); // what duite.hpp lacks is called as in C
    }
    std::vector<double> x(N, 1), there;
    for (std::size_t i = N / 3; i < N / 2; i++)
        x[i] = 2;
    for (std::size_t b = 0; b < BLOCKS; b++)
        rt.set(from[b], duite::span<const double>(&x[b * LENGTH], LENGTH));

    duite::object<double> change(rt, 1);
    duite::object<std::int32_t> more(rt, 1);
    const auto half = [&](const std::vector<duite::object<double>> &a, const std::vector<duite::object<double>> &b) {
        rt.set(change, 0.0);
        for (std::size_t i = 0; i < BLOCKS; i++)
            rt.fork(SPREAD, heat{0.1}, a[(i + BLOCKS - 1) % BLOCKS], a[i], a[(i + 1) % BLOCKS], b[i], change);
        rt.fork(JUDGE, change, more);
    };
    duite::graph round(rt, [&] { half(from, to); });
    const heat by{0.2};
    std::int32_t goes_on = 1;
    int rounds = 0;
    for (std::size_t k = 0; k < BLOCKS; k++)
        round.args(k, by); // sets do not count, and JUDGE is fork BLOCKS
    for (; goes_on && rounds < MOST; rounds++) {
        for (std::size_t b = 0; b < BLOCKS; b++) { // there in even rounds, back in odd ones
            round.bind(from[b], (rounds % 2 ? to : from)[b]);
            round.bind(to[b], (rounds % 2 ? from : to)[b]);
        }
        round.replay();
        rt.get(more, goes_on);
    }

    std::vector<double> found;
    for (const auto &block : rounds % 2 ? to : from) {
        const std::vector<double> values = rt.get(block);
        found.insert(found.end(), values.begin(), values.end());
    }
    if (duite_rank(rt.c()) == 0)
        std::printf("stencil: %d rounds\n", rounds);
    return plain(x, by) == rounds && found == x;
}

} // namespace

int main()
{
    try {
        duite::runtime rt(SPREAD, JUDGE);
        const bool right = run(rt);
        rt.stop(); // tells the errors that nobody asked for
        return right ? 0 : 1;
    } catch (const duite::error &failure) {
        std::fprintf(stderr, "stencil: %s (%d)\n", failure.what(), failure.code());
        return 1;
    }
}
