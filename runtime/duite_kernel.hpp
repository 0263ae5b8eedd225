#ifndef DUITE_KERNEL_HPP
#define DUITE_KERNEL_HPP

/* Kernels from lambdas, for duite.hpp: errors, elements, parameters and what is found out about a lambda. */

#include <duite.h>

#include <complex>
#include <iterator>
#include <new>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#if defined(DUITE_NO_EXCEPTIONS) || !defined(__cpp_exceptions)
#define DUITE_FRONT codes
#else
#define DUITE_FRONT exceptions
#define DUITE_THROWS
#endif

/* Users' names are members of struct duite, at the end, as no namespace can have the name of the handle. The inner namespace lets files
 * of one program differ in how they learn of errors. */
namespace duite_front
{
inline namespace DUITE_FRONT
{

#ifdef DUITE_THROWS
class error : public std::runtime_error
{
    int code_;

  public:
    error(int code, const std::string &message) : std::runtime_error(message), code_(code ? code : 1) {}
    int code() const noexcept { return code_; }
};
#endif

inline int told(int code)
{
#ifdef DUITE_THROWS
    if (code)
        throw error(code, duite_message());
#endif
    return code;
}

/* ---- Elements and objects ---- */

template <typename T> constexpr duite_type type_of()
{
    static_assert(std::is_trivially_copyable_v<T>, "elements are copied as bytes: their type has to be trivially copyable");
    constexpr duite_type whole[] = {DUITE_I8, DUITE_U8, DUITE_I16, DUITE_U16, DUITE_I32, DUITE_U32, DUITE_I64, DUITE_U64};
    constexpr int size = (sizeof(T) > 1) + (sizeof(T) > 2) + (sizeof(T) > 4);
    return std::is_same_v<T, double>                                                             ? DUITE_F64
           : std::is_same_v<T, float>                                                            ? DUITE_F32
           : std::is_same_v<T, std::complex<double>>                                             ? DUITE_CF64
           : std::is_same_v<T, std::complex<float>>                                              ? DUITE_CF32
           : std::is_integral_v<T> && !std::is_same_v<T, bool> && sizeof(T) <= sizeof(long long) ? whole[2 * size + std::is_unsigned_v<T>]
                                                                                                 : DUITE_BYTE;
}
/* Elements of duite.h in one T. */
template <typename T> inline constexpr std::size_t unit = type_of<T>() == DUITE_BYTE ? sizeof(T) : 1;

/* Elements in a row that belong to somebody else. */
template <typename T> class span
{
    T *data_ = nullptr;
    std::size_t size_ = 0;

  public:
    using value_type = std::remove_cv_t<T>;
    constexpr span() noexcept = default;
    constexpr span(T *data, std::size_t size) noexcept : data_(data), size_(size) {}
    template <typename C, typename = std::enable_if_t<std::is_convertible_v<decltype(std::data(std::declval<C &>())), T *>>>
    constexpr span(C &&of) : data_(std::data(of)), size_(std::size(of)) {}
    constexpr T *data() const noexcept { return data_; }
    constexpr std::size_t size() const noexcept { return size_; }
    constexpr T *begin() const noexcept { return data_; }
    constexpr T *end() const noexcept { return data_ + size_; }
    constexpr T &operator[](std::size_t i) const { return data_[i]; }
};

/* Names an object: a value, freely copied. count: of its elements; 0: it changes, or is not known here. */
template <typename T> struct ref {
    duite_object name = DUITE_NO_OBJECT;
    std::size_t count = 0;
};

/* ---- Parameters of kernels ---- */

struct parameter {};
template <duite_mode Mode, typename T> using elements = span<std::conditional_t<Mode == DUITE_R, const T, T>>;

/* An object under a mode: its elements, if the body may use them, and its name for children. */
template <duite_mode Mode, typename T, const duite_law &Law = duite_sum>
class access : public elements<Mode, T>, public ref<T>, public parameter
{
    const duite_call *call_;
    std::size_t i_;

  public:
    using element = T;
    static constexpr duite_mode mode = Mode;
    static constexpr const duite_law &law = Law;
    access(const duite_call *call, std::size_t i)
        : elements<Mode, T>(static_cast<T *>(call->param[i].data), Mode < DUITE_RP ? call->param[i].count / unit<T> : 0),
          ref<T>{call->param[i].object, 0}, call_(call), i_(i)
    {
    }
    std::size_t max() const { return call_->param[i_].max / unit<T>; } /* room, see resize */
    int resize(std::size_t size)
    {
        static_assert(Mode == DUITE_W || Mode == DUITE_RW, "only what is written changes its size");
        const int code = duite_resize(call_, i_, size * unit<T>);
        if (!code)
            elements<Mode, T>::operator=(elements<Mode, T>(this->data(), size));
        return told(code);
    }
    span<T> contribute()
    {
        static_assert(Mode == DUITE_CWP, "contributions of a body itself go to postponed<sum<T>> and its like");
        void *values = duite_contribute(call_, i_);
        told(values ? DUITE_OK : DUITE_E_MEMORY);
        return {static_cast<T *>(values), values ? call_->param[i_].count / unit<T> : 0};
    }
};

/* Any number of further parameters A. */
struct further {};
template <typename A> class rest : public parameter, public further
{
    const duite_call *call_;
    std::size_t first_;

  public:
    using element = typename A::element;
    static constexpr duite_mode mode = A::mode;
    static constexpr const duite_law &law = A::law;
    rest(const duite_call *call, std::size_t first) : call_(call), first_(first) {}
    std::size_t size() const { return call_->n_params - first_; }
    A operator[](std::size_t i) const { return A(call_, first_ + i); }
};

/* ---- Kernels ---- */

class task;
struct no_arguments {};
template <typename P> using bare = std::remove_cv_t<std::remove_reference_t<P>>;
template <typename P> constexpr bool is_task = std::is_same_v<bare<P>, task>;
template <typename P> constexpr bool is_object = std::is_base_of_v<parameter, bare<P>>;
template <typename P> constexpr bool is_rest = std::is_base_of_v<further, bare<P>>;

/* The parameters P of a lambda that returns R: tasks, then arguments, then objects. */
template <typename R, typename... P> struct shape {
    using result = R;
    static constexpr std::size_t n = sizeof...(P), tasks = (0 + ... + is_task<P>), objects = (0 + ... + is_object<P>),
                                 before = n - objects, rests = (0 + ... + is_rest<P>), fixed = objects - rests;
    static constexpr bool has_args = before > tasks;
    template <std::size_t I> using at = bare<std::tuple_element_t<I, std::tuple<P..., no_arguments>>>;
    using args = at<has_args ? tasks : n>;
    template <std::size_t I> using object = at<before + I>;
    static constexpr bool is_in_order()
    {
        const bool first[] = {is_task<P>..., false}, taken[] = {is_object<P>..., true}, last[] = {false, is_rest<P>...};
        bool right = before <= tasks + 1 && tasks == first[0] && rests == last[n];
        for (std::size_t i = 0; i < before; i++)
            right = right && !taken[i];
        return right;
    }
};
template <typename C, typename R, typename... P> shape<R, P...> shape_from(R (C::*)(P...) const);
template <typename C, typename R, typename... P> shape<R, P...> shape_from(R (C::*)(P...) const noexcept);
template <typename F, typename = void> struct shape_of {
    static_assert(!sizeof(F), "a kernel is a lambda that is not mutable and names the types of its parameters");
};
template <typename F> struct shape_of<F, std::void_t<decltype(shape_from(&F::operator()))>> {
    using type = decltype(shape_from(&F::operator()));
};

enum : unsigned { side_effects = 1, fixed = 2, replicated = 4, events = 8 };

template <typename F> class kernel_of
{
  public:
    static_assert(std::is_empty_v<F>, "a kernel captures nothing, as its tasks may run on other ranks: give it objects or arguments");
    using form = typename shape_of<F>::type;
    static_assert(form::is_in_order(), "a kernel takes a task & or none, one structure of arguments or none, then objects "
                                       "(duite::read<T> and its like), a duite::rest last");
    static_assert(std::is_trivially_copyable_v<typename form::args> && alignof(typename form::args) <= 8,
                  "a kernel's arguments are copied as bytes: their type has to be trivially copyable, aligned to 8 bytes at most");
    static_assert(std::is_void_v<typename form::result> || std::is_same_v<typename form::result, int>,
                  "a kernel returns nothing, or an int: 0 or the code of its failure");

    kernel_of(const char *name, unsigned traits)
    {
        kernel_.name = name;
        kernel_.body = body;
        set_objects(std::make_index_sequence<form::fixed>());
        kernel_.law = laws_;
        if constexpr (form::rests > 0) {
            kernel_.variadic = form::template object<form::fixed>::mode;
            kernel_.variadic_law = law<form::fixed>();
        }
        kernel_.args_size = form::has_args ? sizeof(typename form::args) : 0;
        kernel_.side_effects = (traits & side_effects) != 0;
        kernel_.fixed = (traits & fixed) != 0;
        kernel_.replicated = (traits & replicated) != 0;
        kernel_.events = (traits & events) != 0;
    }
    kernel_of(const kernel_of &) = delete; /* the runtime knows it by its address */
    const duite_kernel *c() const noexcept { return &kernel_; }

  private:
    duite_kernel kernel_{};
    const duite_law *laws_[form::fixed + 1]{}; /* an array has elements, also that of no objects */

    template <std::size_t I> static const duite_law *law()
    {
        using P = typename form::template object<I>;
        return P::mode == DUITE_CW || P::mode == DUITE_CWP ? &P::law : nullptr;
    }
    template <std::size_t... I> void set_objects(std::index_sequence<I...>)
    {
        ((kernel_.access[I] = static_cast<std::uint8_t>(form::template object<I>::mode), laws_[I] = law<I>()), ...);
    }
    template <std::size_t I> static decltype(auto) pass([[maybe_unused]] task &here, [[maybe_unused]] const duite_call *call)
    {
        using P = typename form::template at<I>;
        if constexpr (is_task<P>)
            return (here);
        else if constexpr (is_object<P>)
            return P(call, I - form::before);
        else
            return (*static_cast<const P *>(call->args));
    }
    template <std::size_t... I>
    static int run([[maybe_unused]] task &here, [[maybe_unused]] const duite_call *call, std::index_sequence<I...>)
    {
        alignas(F) static const unsigned char nothing[sizeof(F)] = {}; /* a closure without captures, of which no byte is read */
        const F &lambda = *std::launder(reinterpret_cast<const F *>(nothing));
        if constexpr (std::is_void_v<typename form::result>)
            return lambda(pass<I>(here, call)...), DUITE_OK;
        else
            return lambda(pass<I>(here, call)...);
    }
    static int body(const duite_call *call);
};

} // namespace DUITE_FRONT
} // namespace duite_front

#endif
