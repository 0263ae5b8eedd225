#ifndef DUITE_HPP
#define DUITE_HPP

/* duite for C++17: what duite.h says, with kernels from lambdas, objects of a type, and errors as exceptions. All of it is inline over
 * the functions of duite.h. Those that have nothing here are called beside it: duite_colocate(rt.c(), y.name, x.name).
 *
 *     const duite::kernel SCALE("scale", [](const double &by, duite::readwrite<double> x) {
 *         for (double &each : x)
 *             each *= by;
 *     });
 *     duite::runtime rt(SCALE);
 *     duite::object<double> x(rt, 1000);
 *     rt.fork(SCALE, 2.0, x);
 *     std::vector<double> values = rt.get(x);
 *
 * A kernel is a lambda that captures nothing. Its parameters are, in this order: a duite::task & if it forks, fails or makes events;
 * its arguments (a structure, or one value) if it has some; its objects, whose types say mode and elements: numbers, or any type that
 * can be copied byte by byte. A runtime gets all its kernels, and finds their laws; they stay in place until it has stopped.
 *
 * Errors: a call that fails throws duite::error, with code and message; what a body throws of std::exception is its failure. Where
 * exceptions are off, or DUITE_NO_EXCEPTIONS is defined, calls return the code, and constructors leave it to the next get, wait or
 * stop, as duite.h does. Destructors throw nothing: their errors are remembered, for the next get, wait or stop. So that the last ones
 * are not lost, call stop() before the runtime goes.
 *
 * Objects, graphs and turns end when they go, and do nothing then if the runtime has stopped. They may not outlive the duite::runtime
 * or duite::task that they were made with. */

#include <duite_kernel.hpp>

#include <exception>
#include <functional>
#include <initializer_list>
#include <memory>
#include <vector>

namespace duite_front
{
inline namespace DUITE_FRONT
{

/* Those of the main program and of bodies. */
class calls
{
  public:
    calls(const calls &) = delete;
    duite *c() const noexcept { return rt_; }
    duite *const *handle() const noexcept { return &rt_; } /* NULL is there once the runtime has stopped */

    /* The kernel's arguments, if it has some, then an object for each parameter; for a rest a container of objects. */
    template <typename F, typename... Given> int fork(const kernel_of<F> &kernel, const Given &...given)
    {
        return start(nullptr, kernel, given...);
    }
    template <typename F, typename... Given>
    int fork_with(const duite_task_options &options, const kernel_of<F> &kernel, const Given &...given)
    {
        return start(&options, kernel, given...);
    }
    int wait() { return told(duite_wait(rt_)); }
    template <typename... T> int wait_for(const ref<T> &...objects)
    {
        const duite_object names[] = {objects.name..., DUITE_NO_OBJECT};
        return told(duite_wait_for(rt_, sizeof...(T), names));
    }
    template <typename T> int set(ref<T> to, span<const std::common_type_t<T>> values)
    {
        return told(duite_set_sized(rt_, to.name, values.data(), values.size() * unit<T>));
    }
    template <typename T> int set(ref<T> to, const std::common_type_t<T> &value) { return set(to, span<const T>(&value, 1)); }
    template <typename T> int get(ref<T> from, std::vector<T> &values)
    {
        std::size_t count = from.count * unit<T>;
        const int code = count ? DUITE_OK : duite_get_count(rt_, from.name, &count);
        if (code)
            return told(code);
        values.resize(count / unit<T>);
        return told(duite_get(rt_, from.name, values.data()));
    }
    template <typename T> int get(ref<T> from, T &first)
    {
        std::vector<T> values;
        const int code = get(from, values);
        if (!code && !values.empty())
            first = values[0];
        return code;
    }
    /* Parts of an object, one after the other, until join() makes it whole again. */
    template <typename T> std::vector<ref<T>> split(ref<T> whole, const std::vector<std::size_t> &counts)
    {
        std::vector<std::size_t> sizes;
        std::vector<duite_object> names(counts.size(), DUITE_NO_OBJECT);
        std::vector<ref<T>> parts;
        for (const std::size_t count : counts)
            sizes.push_back(count * unit<T>);
        told(duite_split(rt_, whole.name, sizes.size(), sizes.data(), names.data()));
        for (std::size_t i = 0; i < names.size(); i++)
            parts.push_back({names[i], counts[i]});
        return parts;
    }
    template <typename T> int join(ref<T> whole) { return told(duite_join(rt_, whole.name)); }
#ifdef DUITE_THROWS
    template <typename T> std::vector<T> get(ref<T> from)
    {
        std::vector<T> values;
        get(from, values);
        return values;
    }
#endif

  protected:
    duite *rt_;
    explicit calls(duite *rt) : rt_(rt) {}

  private:
    template <typename F, typename... Given>
    int start(const duite_task_options *options, const kernel_of<F> &kernel, const Given &...given)
    {
        using form = typename kernel_of<F>::form;
        static_assert(sizeof...(Given) == form::has_args + form::objects,
                      "a fork gives the kernel's arguments, if it has some, and an object for each parameter");
        if constexpr (!form::has_args)
            return start_on(options, kernel, nullptr, std::index_sequence_for<Given...>(), given...);
        else
            return [&](const typename form::args &args, const auto &...objects) {
                return start_on(options, kernel, &args, std::index_sequence_for<decltype(objects)...>(), objects...);
            }(given...);
    }
    template <typename F, std::size_t... I, typename... Objects>
    int start_on(const duite_task_options *options, const kernel_of<F> &kernel, const void *args, std::index_sequence<I...>,
                 const Objects &...objects)
    {
        using form = typename kernel_of<F>::form;
        constexpr std::size_t room = sizeof...(I) + 1;
        std::conditional_t<(form::rests > 0), std::vector<duite_object>, duite_object[room]> names = {
            name_of<typename form::template object<I>>(objects)..., DUITE_NO_OBJECT};
        std::size_t n = sizeof...(I);
        if constexpr (form::rests > 0) {
            names.resize(form::fixed);
            (add_rest<typename form::template object<I>>(names, objects), ...);
            n = names.size();
        }
        const duite_object *first = std::data(names);
        return told(options ? duite_fork_with(rt_, options, kernel.c(), args, n, first) : duite_fork(rt_, kernel.c(), args, n, first));
    }
    template <typename P, typename Given> static duite_object name_of(const Given &given)
    {
        using names = const ref<typename P::element> &;
        static_assert(is_rest<P> || std::is_convertible_v<const Given &, names>,
                      "an object given to a fork has elements of the type of the kernel's parameter");
        if constexpr (is_rest<P>)
            return DUITE_NO_OBJECT;
        else
            return static_cast<names>(given).name;
    }
    template <typename P, typename Given> static void add_rest(std::vector<duite_object> &names, const Given &given)
    {
        if constexpr (is_rest<P>)
            for (const ref<typename P::element> &each : given)
                names.push_back(each.name);
    }
};

/* An object that this one owns. most: its size changes, up to so many elements. rank, memory: of the program's own memory on one rank
 * (duite_adopt), which has it back when this object has gone and a wait is over; other ranks say nullptr. */
template <typename T> class object : public ref<T>
{
    duite *const *rt_;
    std::size_t max_;

  public:
    object(const calls &where, std::size_t size) : ref<T>{{}, size}, rt_(where.handle()), max_(size)
    {
        told(duite_new(*rt_, type_of<T>(), size * unit<T>, &this->name));
    }
    object(const calls &where, std::size_t size, std::size_t most) : ref<T>{{}, 0}, rt_(where.handle()), max_(most)
    {
        told(duite_new_sized(*rt_, type_of<T>(), size * unit<T>, most * unit<T>, &this->name));
    }
    object(const calls &where, int rank, std::size_t size, T *memory) : ref<T>{{}, size}, rt_(where.handle()), max_(size)
    {
        told(duite_adopt(*rt_, rank, type_of<T>(), size * unit<T>, memory, nullptr, nullptr, &this->name));
    }
    object(object &&from) noexcept : ref<T>(from), rt_(std::exchange(from.rt_, nullptr)), max_(from.max_) {}
    object &operator=(object &&from) noexcept
    {
        std::swap(static_cast<ref<T> &>(*this), static_cast<ref<T> &>(from));
        std::swap(rt_, from.rt_);
        std::swap(max_, from.max_);
        return *this;
    }
    ~object()
    {
        if (rt_ && *rt_ && this->name.generation) /* else it was never made */
            duite_free(*rt_, this->name);
    }
    std::size_t max() const noexcept { return max_; }
};

/* Keeps its task from ending until complete() is called, by any thread. A value. */
struct event {
    duite *rt;
    duite_event name;
    int complete(int code = DUITE_OK) const { return told(duite_complete(rt, name, code)); }
};

/* The calls of a body; dies with it. */
class task : public calls
{
    const duite_call *call_;

  public:
    explicit task(const duite_call *call) : calls(call->rt), call_(call) {}
    const duite_call *call() const noexcept { return call_; }
    /* For `return here.fail(1, "...")`. */
    int fail(int code, const std::string &text) const { return duite_fail(call_, code, "%s", text.c_str()); }
    event make_event() const
    {
        event made{rt_, {}};
        told(duite_event_new(call_, &made.name));
        return made;
    }
    int await_mpi(span<MPI_Request> requests) const
    {
        return told(duite_await_mpi(call_, static_cast<int>(requests.size()), requests.data()));
    }
};

template <typename F> int kernel_of<F>::body(const duite_call *call)
{
    task here(call);
#ifdef DUITE_THROWS
    try {
        return run(here, call, std::make_index_sequence<form::n>());
    } catch (const error &failure) {
        return here.fail(failure.code(), failure.what());
    } catch (const std::exception &failure) {
        return here.fail(1, failure.what());
    }
#else
    return run(here, call, std::make_index_sequence<form::n>());
#endif
}

/* The main program's turn on an object (duite_acquire): its elements on its home, else none. code(): the failure that the value
 * descends from, which its home alone is told. */
template <duite_mode Mode, typename T> class turn : public elements<Mode, T>
{
    duite *const *rt_;
    duite_object name_;
    int code_;

    static bool is_refused(int code) /* by the call; other codes are those of failed tasks */
    {
        return code == DUITE_E_ARGUMENT || code == DUITE_E_OBJECT || code == DUITE_E_STATE || code == DUITE_E_MEMORY ||
               code == DUITE_E_MPI || code == DUITE_E_LOST;
    }

  public:
    turn(const calls &where, const object<T> &of) : rt_(where.handle()), name_(of.name)
    {
        std::size_t count = (Mode == DUITE_W ? of.max() : of.count) * unit<T>;
        void *data = nullptr;
        code_ = count ? DUITE_OK : duite_get_count(*rt_, name_, &count);
        if (code_ || is_refused(code_ = duite_acquire(*rt_, name_, Mode, &data))) {
            rt_ = nullptr; /* there is no turn to release */
            told(code_);
        }
        elements<Mode, T>::operator=(elements<Mode, T>(static_cast<T *>(data), data ? count / unit<T> : 0));
    }
    turn(const turn &) = delete;
    ~turn()
    {
        if (rt_ && *rt_)
            duite_release(*rt_, name_);
    }
    int code() const noexcept { return code_; }
    int release()
    {
        duite *const *rt = std::exchange(rt_, nullptr);
        elements<Mode, T>::operator=(elements<Mode, T>());
        return rt ? told(duite_release(*rt, name_)) : DUITE_OK;
    }
};

/* ---- The main program ---- */

struct options : duite_options {
    options() : duite_options(duite_options_default()) {}
};

/* A running runtime; its destructor stops it. Kernels of options stand before those that are given. */
class runtime : public calls
{
  public:
    template <typename... F> explicit runtime(const duite_options &given, const kernel_of<F> &...kernels) : calls(nullptr)
    {
        std::vector<const duite_kernel *> list;
        std::vector<const duite_law *> laws;
        for (auto each = given.kernels; each && *each; each++)
            list.push_back(*each);
        for (auto each = given.laws; each && *each; each++)
            laws.push_back(*each);
        (list.push_back(kernels.c()), ..., list.push_back(nullptr));
        for (const duite_kernel *kernel : std::initializer_list<const duite_kernel *>{kernels.c()...})
            for (std::size_t i = 0, listed = 1; listed; i++) {
                listed = i < DUITE_MAX_ACCESS && kernel->access[i] != DUITE_NONE;
                if (const duite_law *law = listed ? kernel->law[i] : kernel->variadic_law)
                    laws.push_back(law);
            }
        laws.push_back(nullptr);
        duite_options whole = given;
        whole.kernels = list.data();
        whole.laws = laws.data();
        told(duite_start(&rt_, &whole));
    }
    template <typename... F> explicit runtime(const kernel_of<F> &...kernels) : runtime(options(), kernels...) {}
    ~runtime()
    {
        if (rt_)
            duite_stop(&rt_);
    }
    explicit operator bool() const noexcept { return rt_; }
    int stop() { return told(duite_stop(&rt_)); }
    int add(const duite_kernel *kernel) { return told(duite_kernel_add(rt_, kernel)); } /* of a library that was loaded later */
    template <typename... T> bool test(const ref<T> &...objects)
    {
        const duite_object names[] = {objects.name..., DUITE_NO_OBJECT};
        int there = 0;
        told(duite_test(rt_, sizeof...(T), names, &there));
        return there;
    }
    template <typename T> turn<DUITE_R, T> acquire_read(const object<T> &of) { return {*this, of}; }
    template <typename T> turn<DUITE_W, T> acquire_write(const object<T> &of) { return {*this, of}; }
    template <typename T> turn<DUITE_RW, T> acquire(const object<T> &of) { return {*this, of}; }
};

/* A recorded graph of what `build` forks and sets. It is kept, as it may be called again; what it throws, the call throws. */
class graph
{
    struct recipe {
        std::function<void()> build;
        std::exception_ptr thrown;
    };
    duite *const *rt_;
    duite_graph name_{};
    std::unique_ptr<recipe> recipe_;

    static int record(duite *, void *context)
    {
        auto *of = static_cast<recipe *>(context);
#ifdef DUITE_THROWS
        try {
            of->build();
        } catch (...) {
            of->thrown = std::current_exception();
            return 1;
        }
#else
        of->build();
#endif
        return DUITE_OK;
    }
    int heard(int code)
    {
        if (recipe_->thrown)
            std::rethrow_exception(std::exchange(recipe_->thrown, nullptr));
        return told(code);
    }

  public:
    graph(const runtime &where, std::function<void()> build) : rt_(where.handle()), recipe_(new recipe{std::move(build), {}})
    {
        heard(duite_graph_new(*rt_, record, recipe_.get(), &name_));
    }
    graph(graph &&from) noexcept : rt_(std::exchange(from.rt_, nullptr)), name_(from.name_), recipe_(std::move(from.recipe_)) {}
    ~graph()
    {
        if (rt_ && *rt_ && name_.generation)
            duite_graph_free(*rt_, name_);
    }
    int replay(std::uint64_t rounds = 1) { return heard(duite_replay(*rt_, name_, rounds)); }
    template <typename T> int replay_while(const ref<T> &flag, std::uint64_t most)
    {
        return heard(duite_replay_while(*rt_, name_, flag.name, most));
    }
    int rounds(std::uint64_t &rounds) { return heard(duite_graph_rounds(*rt_, name_, &rounds)); } /* of the last replay */
    template <typename T> int bind(const ref<T> &recorded, const ref<T> &object)
    {
        return heard(duite_graph_bind(*rt_, name_, recorded.name, object.name));
    }
    /* The arguments of fork k of `build`, of the type that its kernel takes. */
    template <typename A> int args(std::size_t k, const A &args) { return heard(duite_graph_args(*rt_, name_, k, &args)); }
};

} // namespace DUITE_FRONT
} // namespace duite_front

struct duite {
    template <typename T> using span = duite_front::span<T>;
    template <typename T> using ref = duite_front::ref<T>;
    template <typename T> using object = duite_front::object<T>;
    using runtime = duite_front::runtime;
    using options = duite_front::options;
    using task = duite_front::task;
    using event = duite_front::event;
    using graph = duite_front::graph;
#ifdef DUITE_THROWS
    using error = duite_front::error;
#endif

    /* Modes, see duite_mode. accumulate: by any law, of duite.h or of the program. */
    template <typename T> using read = duite_front::access<DUITE_R, T>;
    template <typename T> using write = duite_front::access<DUITE_W, T>;
    template <typename T> using readwrite = duite_front::access<DUITE_RW, T>;
    template <typename T, const duite_law &Law> using accumulate = duite_front::access<DUITE_CW, T, Law>;
    template <typename T> using sum = accumulate<T, duite_sum>;
    template <typename T> using min = accumulate<T, duite_min>;
    template <typename T> using max = accumulate<T, duite_max>;
    /* The same, left to children; and any number of further ones. */
    template <typename A> using postponed =
        duite_front::access<static_cast<duite_mode>(A::mode + (DUITE_RP - DUITE_R)), typename A::element, A::law>;
    template <typename A> using rest = duite_front::rest<A>;

    /* Traits of a kernel, see duite_kernel; they combine by |. */
    static constexpr unsigned side_effects = duite_front::side_effects, fixed = duite_front::fixed,
                              replicated = duite_front::replicated, events = duite_front::events;
    template <typename F> struct kernel : duite_front::kernel_of<F> {
        kernel(const char *name, F, unsigned traits = 0) : duite_front::kernel_of<F>(name, traits) {}
    };
};

#undef DUITE_FRONT
#undef DUITE_THROWS

#endif
