// The dot product of two vectors in blocks, in C++17: each task adds its block's share to one sum. With
// x[i] = i + 1 and y[i] = 2 it is n (n + 1), exactly.

#include <duite.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>
#include <vector>

namespace {

constexpr std::size_t BLOCKS = 13, LENGTH = 1000, N = BLOCKS * LENGTH;

struct fill {
    double first, step;
};

int fill_block(const duite_call *call) // x[i] = first + step i
{
    const auto *args = static_cast<const fill *>(call->args);
    double *x = duite_out(call, 0, double);
    for (std::size_t i = 0; i < duite_count(call, 0); i++)
        x[i] = args->first + args->step * static_cast<double>(i);
    return DUITE_OK;
}

int dot_blocks(const duite_call *call) // sum += x . y
{
    const double *x = duite_in(call, 0, double), *y = duite_in(call, 1, double);
    *duite_out(call, 2, double) += std::inner_product(x, x + duite_count(call, 0), y, 0.0);
    return DUITE_OK;
}

duite_kernel kernel(const char *name, duite_body *body, std::initializer_list<duite_mode> access, std::size_t args_size)
{
    duite_kernel made{}; // C++20 has designated initialisers, as C
    made.name = name;
    made.body = body;
    std::copy(access.begin(), access.end(), made.access);
    made.args_size = args_size;
    return made;
}

const duite_kernel FILL = kernel("fill", fill_block, {DUITE_W}, sizeof(fill));
const duite_kernel DOT = kernel("dot", dot_blocks, {DUITE_R, DUITE_R, DUITE_CW}, 0);

double run(duite *rt)
{
    std::array<std::vector<duite_object>, 2> vectors{std::vector<duite_object>(BLOCKS, DUITE_NO_OBJECT),
                                                     std::vector<duite_object>(BLOCKS, DUITE_NO_OBJECT)};
    auto &[x, y] = vectors;
    duite_object sum = DUITE_NO_OBJECT;
    double result = 0;
    duite_new(rt, DUITE_F64, 1, &sum);
    for (std::size_t b = 0; b < BLOCKS; b++) {
        duite_new(rt, DUITE_F64, LENGTH, &x[b]);
        duite_new(rt, DUITE_F64, LENGTH, &y[b]);
        duite_colocate(rt, y[b], x[b]); // on the same rank
        DUITE_FORK(rt, &FILL, DUITE_ARGS(struct fill, static_cast<double>(b * LENGTH + 1), 1), x[b]);
        DUITE_FORK(rt, &FILL, DUITE_ARGS(fill, 2, 0), y[b]);
        DUITE_FORK(rt, &DOT, nullptr, x[b], y[b], sum);
    }
    if (duite_get(rt, sum, &result)) // tells the errors of all calls above, too
        std::fprintf(stderr, "dot: %s\n", duite_message());
    for (const auto &vector : vectors)
        for (const duite_object block : vector)
            duite_free(rt, block);
    duite_free(rt, sum);
    return result;
}

} // namespace

int main()
{
    const duite_kernel *const kernels[] = {&FILL, &DOT, nullptr};
    duite_options options = duite_options_default();
    duite *rt = nullptr;
    options.kernels = kernels;
    if (duite_start(&rt, &options))
        return std::fprintf(stderr, "dot: %s\n", duite_message()), 1;
    const double result = run(rt);
    if (duite_rank(rt) == 0)
        std::printf("dot: %.0f\n", result);
    if (duite_stop(&rt)) // tells the errors that nobody asked for
        return std::fprintf(stderr, "dot: %s\n", duite_message()), 1;
    return result == static_cast<double>(N * (N + 1)) ? 0 : 1;
}
