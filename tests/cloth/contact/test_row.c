/* The force of a contact, by a mass on a tilted plane in linear implicit steps, as solves make
 * them: it rests, sticks up to the angle of Coulomb's law, slides with its acceleration beyond, and
 * stops. */
#include "cloth/contact/row.h"
#include "tests/support/unit.h"

static const double G = 9.81, THICKNESS = 1e-3, DEGREE = 0.017453292519943295,
                    RIGHT = 1.001 * CONTACT_ROW_RIGHT *
                            THICKNESS; /* gaps end so near, but for rounding */

struct mass {
    double kg, k, h;
    phys_vec x, v, down; /* m, m/s, m/s^2 */
    struct contact_row row;
};

/* On a plane through the origin with the slope tan = rise / run. */
static struct mass make(double angle, double friction)
{
    struct mass mass = {.kg = 1e-5, .k = 30, .h = 0.004};
    mass.row.normal = (phys_vec){-sin(angle), cos(angle), 0, 0};
    mass.row.thickness = THICKNESS;
    mass.row.friction = friction;
    mass.row.stiffness = mass.k;
    mass.x = THICKNESS * mass.row.normal;
    mass.down = (phys_vec){0, -G, 0, 0};
    return mass;
}

/* Solves (m + h^2 (alpha + w w')) dv = b: by the formula of Sherman and Morrison. */
static void solve(double m, double h, const phys_vec *value, const phys_vec *b, phys_vec *dv)
{
    const phys_vec three = {1, 1, 1, 0}, w = *value * three;
    const double d = m + h * h * (*value)[3], ww = h * h * phys_dot(&w, &w);
    *dv = 1 / d * (*b - h * h * phys_dot(&w, b) / (d + ww) * w);
}

static void step(struct mass *mass)
{
    struct contact_row *row = &mass->row;
    phys_vec force, value, dv;
    row->origin = mass->x;
    row->gap = phys_dot(&row->normal, &mass->x);
    contact_row_begin(row, mass->k, 1);
    const phys_vec point = mass->x + mass->h * mass->v;
    contact_row_linearise(row, &point, &force, &value);
    const phys_vec b = mass->h * (force + mass->kg * mass->down);
    solve(mass->kg, mass->h, &value, &b, &dv);
    mass->v += dv;
    mass->x += mass->h * mass->v;
    const struct contact_row before = *row;
    contact_row_end(&before, &mass->x, row);
}

static void run(struct mass *mass, double seconds)
{
    for (int i = 0; i < (int)(seconds / mass->h + 0.5); i++)
        step(mass);
}

/* k of a loaded contact is load / thickness, but at least that of others, and at most what a row
 * may be firm. */
UNIT_TEST(loads_stiffen)
{
    static const double times[][2] = {{0, 1}, {0.5, 1}, {10, 10}, {200, 200}, {1e4, 256}};
    for (size_t i = 0; i < sizeof times / sizeof *times; i++) {
        struct mass mass = make(0, 0);
        mass.row.gap = THICKNESS;
        mass.row.rested = times[i][0] * mass.k * THICKNESS;
        contact_row_begin(&mass.row, mass.k, 1);
        ck_assert_double_eq_tol(mass.row.stiffness / mass.k, times[i][1], 1e-12 * times[i][1]);
    }
}

UNIT_TEST(rests)
{
    struct mass mass = make(0, 0);
    mass.x += (phys_vec){0, 0.01, 0, 0};
    run(&mass, 2);
    ck_assert_double_eq_tol(mass.row.load, mass.kg * G, 1e-6 * mass.kg * G);
    ck_assert_double_eq_tol(mass.x[1], THICKNESS, RIGHT);
    ck_assert_double_eq_tol(mass.v[1], 0, 1e-9);
}

/* Half a degree below the angle it is where it was, half a degree above it slides. */
UNIT_TEST(sticks_and_slips)
{
    const double friction = 0.4, limit = atan(friction), half = 0.5 * DEGREE;
    struct mass below = make(limit - half, friction), above = make(limit + half, friction);
    below.row.load = below.row.rested = below.kg * G * cos(limit); /* they rest */
    below.row.energy = below.row.load * below.row.load / below.k;
    above.row = below.row;
    above.row.normal = make(limit + half, friction).row.normal;
    const phys_vec up = {cos(limit - half), sin(limit - half), 0, 0};
    run(&below, 1);
    const phys_vec then = below.x;
    run(&below, 9);
    const phys_vec way = below.x - then;
    ck_assert_double_lt(sqrt(phys_dot(&way, &way)), 1e-9);
    ck_assert_double_lt(fabs(phys_dot(&below.x, &up)), 1e-3);
    run(&above, 10);
    ck_assert_double_gt(sqrt(phys_dot(&above.v, &above.v)), 0.1);
}

UNIT_TEST(slides_as_coulomb_says)
{
    for (int degrees = 20; degrees < 80; degrees += 10) {
        const double angle = degrees * DEGREE, friction = 0.3;
        struct mass mass = make(angle, friction);
        run(&mass, 1);
        const phys_vec before = mass.v;
        run(&mass, 1);
        const phys_vec gained = mass.v - before;
        const double expected = G * (sin(angle) - friction * cos(angle));
        if (expected > 0)
            ck_assert_double_eq_tol(sqrt(phys_dot(&gained, &gained)), expected, 0.01 * expected);
    }
}

/* Friction counts on the load that a step begins with: of all loads it leaves out the last one, as
 * the first step begins with none. So what slides on something new keeps friction load h / mass of
 * speed too much, however the load comes about. */
UNIT_TEST(new_contacts_brake_a_step_late)
{
    const double friction = 0.3, seconds = 0.2;
    struct mass mass = make(0, friction);
    mass.kg = 1e-3;
    mass.v = (phys_vec){1, -0.01, 0, 0}; /* it presses from the first step on */
    run(&mass, seconds);
    const double loads = G * seconds + mass.v[1] + 0.01; /* over mass */
    const double late = friction * mass.row.load / mass.kg * mass.h;
    ck_assert_double_eq_tol(mass.v[0] - (1 - friction * loads), late, 0.1 * late);
}

/* A mass that rises with a load is not in the matrix where it would open. Pulled back in that step,
 * it met no force: the push where it ends is no load, which would throw it up again for ever. */
UNIT_TEST(what_was_not_in_the_matrix_adds_no_load)
{
    const double load = 1e-4, rises = 0.7 * THICKNESS;
    struct mass mass = make(0, 0);
    mass.x[1] = 0.9 * THICKNESS;
    mass.v[1] = rises / mass.h;
    mass.row.load = mass.row.rested = load;
    mass.row.opened = rises;
    mass.row.part = 1;
    mass.down[1] = -2 * mass.v[1] / mass.h;
    step(&mass);
    ck_assert_double_eq_tol(mass.x[1], 0.2 * THICKNESS, 1e-12); /* it fell freely */
    ck_assert_double_eq(mass.row.load, load);
}

/* On level ground it stops after v^2 / (2 friction G), and stays. */
UNIT_TEST(stops)
{
    struct mass mass = make(0, 0.2);
    mass.h = 0.001;
    run(&mass, 0.1); /* the load is there */
    mass.v = (phys_vec){0.6, 0, 0.8, 0};
    const phys_vec from = mass.x;
    run(&mass, 2);
    const phys_vec way = mass.x - from;
    ck_assert_double_eq_tol(sqrt(phys_dot(&way, &way)), 1 / (2 * 0.2 * G), 0.01 / (2 * 0.2 * G));
    ck_assert_double_lt(sqrt(phys_dot(&mass.v, &mass.v)), 1e-9);
    const phys_vec then = mass.x;
    run(&mass, 8);
    const phys_vec crept = mass.x - then;
    ck_assert_double_lt(sqrt(phys_dot(&crept, &crept)), 1e-9);
}

/* The matrix is the derivative of the force where it does not turn over. */
UNIT_TEST(derivative)
{
    struct mass mass = make(0.3, 0.5);
    struct contact_row *row = &mass.row;
    phys_vec point = mass.x - 1e-5 * row->normal + (phys_vec){1e-8, 0, 2e-8, 0}, force, value,
             other, unused;
    row->origin = mass.x;
    row->gap = THICKNESS;
    row->load = 1e-4;
    contact_row_begin(row, mass.k, 1);
    contact_row_linearise(row, &point, &force, &value);
    ck_assert_double_gt(value[3], 0);
    for (int c = 0; c < 3; c++) {
        const phys_vec three = {1, 1, 1, 0}, w = value * three;
        phys_vec d = {0}, expected;
        d[c] = 1e-8;
        const phys_vec moved = point + d;
        contact_row_linearise(row, &moved, &other, &unused);
        expected = value[3] * d + phys_dot(&w, &d) * w;
        const phys_vec error = (force - other) - expected;
        ck_assert_double_lt(sqrt(phys_dot(&error, &error)), 1e-6 * 30 * 1e-8);
    }
}

/* ---- A pinched mass, between two planes that leave one and a half thicknesses ---- */

struct pinch {
    double kg, h, y, v;
    struct contact_row low, high; /* high->normal is down */
};

static const double NEWTONS = 0.5; /* that halve a gap */

static void begin_row(struct contact_row *row, double y, double gap)
{
    row->origin = (phys_vec){0, y, 0, 0};
    row->gap = gap;
    contact_row_begin(row, 30, 1);
}

static double stiffness_of(const phys_vec *value)
{
    const phys_vec three = {1, 1, 1, 0}, w = *value * three;
    return phys_dot(&w, &w) + (*value)[3];
}

/* The planes pinch it where they leave less than two thicknesses. */
static void end_row(struct contact_row *row, double y, double height)
{
    const phys_vec at = {0, y, 0, 0};
    const struct contact_row before = *row;
    contact_row_end(&before, &at, row);
    row->pinched = height < 2 * THICKNESS;
}

/* The upper plane moves from a height to another one. */
static void step_between(struct pinch *pinch, double from, double to)
{
    struct contact_row *row[2] = {&pinch->low, &pinch->high};
    const double h = pinch->h;
    double force = -pinch->kg * G, stiffness = 0;
    begin_row(row[0], pinch->y, pinch->y);
    begin_row(row[1], pinch->y, from - pinch->y);
    row[1]->gap += to - from; /* as flow_contact_ahead */
    const phys_vec ahead = {0, pinch->y + h * pinch->v, 0, 0};
    for (int i = 0; i < 2; i++) {
        phys_vec push, value;
        contact_row_linearise(row[i], &ahead, &push, &value);
        force += push[1];
        stiffness += stiffness_of(&value);
    }
    pinch->v += h * force / (pinch->kg + h * h * stiffness);
    pinch->y += h * pinch->v;
    for (int i = 0; i < 2; i++)
        end_row(row[i], pinch->y, to);
}

static void hold_between(struct pinch *pinch, double height, double seconds)
{
    for (int i = 0; i < (int)(seconds / pinch->h + 0.5); i++)
        step_between(pinch, height, height);
}

/* It has rested on the lower plane when the upper one comes down in a tenth of a second. */
static void close(struct pinch *pinch, double h)
{
    const double high = 3 * THICKNESS, low = 1.5 * THICKNESS;
    const int n = (int)(0.1 / h + 0.5);
    *pinch = (struct pinch){.kg = 2e-5, .h = h, .y = THICKNESS};
    pinch->low = make(0, 0).row;
    pinch->low.hard = NEWTONS;
    pinch->high = pinch->low;
    pinch->high.normal *= -1;
    hold_between(pinch, high, 0.5);
    for (int i = 0; i < n; i++)
        step_between(pinch, high + (low - high) * i / n, high + (low - high) * (i + 1) / n);
}

/* A third more than half: the law at three quarters of the thickness. Its weight is 2e-4 N. */
UNIT_TEST(compressed_mass_has_the_push_of_the_law)
{
    const double lengths[] = {0.001, 0.004, 0.01}, expected = NEWTONS / 3;
    for (int i = 0; i < 3; i++) {
        struct pinch pinch;
        close(&pinch, lengths[i]);
        hold_between(&pinch, 1.5 * THICKNESS, 0.5);
        ck_assert_double_eq_tol(pinch.low.load, expected, 0.002 * expected);
        hold_between(&pinch, 1.5 * THICKNESS, 10);
        ck_assert_double_eq_tol(pinch.low.load, expected, 0.002 * expected);
        ck_assert_double_eq_tol(pinch.low.load - pinch.high.load, pinch.kg * G,
                                1e-6 * pinch.kg * G);
    }
}

/* The plane is gone after ten seconds: the mass flies no faster than the energy of both contacts
 * lets it. */
UNIT_TEST(opened_pinch_gives_back_its_energy)
{
    const double lengths[] = {0.001, 0.004, 0.01};
    for (int i = 0; i < 3; i++) {
        struct pinch pinch;
        close(&pinch, lengths[i]);
        hold_between(&pinch, 1.5 * THICKNESS, 10);
        const double energy = 2 * NEWTONS * THICKNESS * (log(4.0 / 3) - 0.25);
        double fastest = 0;
        for (int step = 0; step < 100; step++) {
            step_between(&pinch, step ? 1 : 1.5 * THICKNESS, 1);
            fastest = fmax(fastest, pinch.v);
        }
        ck_assert_double_lt(fastest, sqrt(2 * energy / pinch.kg));
        hold_between(&pinch, 1, 5);
        ck_assert_double_eq_tol(pinch.low.load, pinch.kg * G, 1e-6 * pinch.kg * G);
        ck_assert_double_eq_tol(pinch.y, THICKNESS, RIGHT);
    }
}

/* A mass that is taken for pinched, and finds room, is not thrown. A spring, N/m, holds it down,
 * and it ends where the law has the spring's force, or where the contact is open. */
static void open_against(double spring)
{
    const double down = 2e-4;
    struct pinch pinch = {.kg = 2e-5, .h = 0.004, .y = 0.6 * THICKNESS};
    double fastest = 0;
    pinch.low = make(0, 0).row;
    pinch.low.hard = NEWTONS;
    pinch.low.load = pinch.low.rested = down;
    for (int i = 0; i < 2500; i++) {
        const double h = pinch.h;
        phys_vec push, value;
        begin_row(&pinch.low, pinch.y, pinch.y);
        const phys_vec ahead = {0, pinch.y + h * pinch.v, 0, 0};
        contact_row_linearise(&pinch.low, &ahead, &push, &value);
        const double force = push[1] - down - spring * (ahead[1] - 0.6 * THICKNESS);
        pinch.v += h * force / (pinch.kg + h * h * (spring + stiffness_of(&value)));
        pinch.y += h * pinch.v;
        fastest = fmax(fastest, pinch.v);
        end_row(&pinch.low, pinch.y, THICKNESS);
    }
    const double held = down + spring * (pinch.y - 0.6 * THICKNESS);
    ck_assert_double_eq_tol(pinch.low.load, held, 1e-6 * held);
    ck_assert_double_gt(pinch.y, THICKNESS / (1 + held / NEWTONS) - 1e-6);
    ck_assert_double_lt(fastest, 0.15 * 0.4 * THICKNESS / pinch.h);
}
UNIT_TEST(contact_that_gives_is_not_thrown)
{
    open_against(0);
    open_against(100);
    open_against(1000);
}
