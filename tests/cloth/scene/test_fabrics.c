/* Materials that a scene names, and those by the sheets of instruments, arrive in the model. */
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <math.h>

static void same_fabric(const struct model_material *m, double density, double warp, double weft,
                        double shear, double rigidity)
{
    ck_assert_int_eq(m->model, MODEL_TRIANGLES);
    ck_assert_int_eq(m->bending, MODEL_HINGES);
    ck_assert_double_eq(m->density, density);
    ck_assert_double_eq_tol(m->stretch, warp, 1e-12 * warp);
    ck_assert_double_eq_tol(model_weft(m), weft, 1e-12 * weft);
    ck_assert_double_eq(m->shear, shear);
    ck_assert_double_eq(m->rigidity[0], rigidity);
    ck_assert_double_eq(m->rigidity[1], rigidity);
}

/* Those that no scene need write, with some of their values changed, and one of the scene's own of
 * the same name. */
UNIT_TEST(named_fabrics)
{
    static const char *const sets[] = {
        "cloths[0].material=denim", "cloths[0].material=silk",
        "materials={linen: {like: rib_knit, density: 0.1, bending: {rigidity: 1}}}",
        "cloths[0].material=rib_knit", "materials={rib_knit: {density: 0.5, stretch: 1}}"};
    UNIT_OWNED(model_free) struct model model = scene_read_right(scene_right, 1, sets);
    ck_assert_uint_eq(model.n_materials, 2);
    ck_assert_str_eq(model.materials[1].name, "denim");
    ck_assert_uint_eq(model.cloths[0].material, 1);
    same_fabric(model.materials + 1, 0.324, 2026.8, 410.5, 53.4, 1.954e-5);
    ck_assert_double_eq(model.materials[1].poisson, 0.0498);
    model_free(&model);
    model = scene_read_right(scene_right, 1, sets + 1);
    same_fabric(model.materials + 1, 0.0347, 2000, 2000, 20, 9.8e-7);
    model_free(&model);
    model = scene_read_right(scene_right, 2, sets + 2);
    ck_assert_str_eq(model.materials[0].name, "linen");
    same_fabric(model.materials, 0.1, 130.3, 85.7, 83.2, 1);
    same_fabric(model.materials + 1, 0.276, 130.3, 85.7, 83.2, 9.04e-6);
    model_free(&model);
    model = scene_read_right(scene_right, 2, sets + 3); /* its own */
    ck_assert_uint_eq(model.n_materials, 1);
    ck_assert_double_eq(model.materials[0].density, 0.5);
}

/* By the sheets of instruments: 500 gf/cm are 490.3 N/m. */
UNIT_TEST(materials_of_instruments)
{
    UNIT_OWNED(model_free)
    struct model model = scene_read_changed(
        "  cotton: {density: 0.2, stretch: 50, damping: {mass: 0.1}}\n",
        "  cotton: {kes: {W: 20, EMT: [5, 4], LT: [1, 0.8], RT: [60, 40], G: 0.5, B: [0.1, 0.05], "
        "2HB: 0.06, MIU: 0.2, T: 0.8, LC: 0.4, WC: 0.2}}\n"
        "  wool: {fast: {W: 200, E5: [0.5, 1], E100: [4, 5], EB5: 3, C: [20, 10], T2: 0.5, T100: "
        "0.3}, friction: 0.4}\n"
        "  own: {kes: {W: 20, EMT: 5, G: 1, 2HG: 2}, shear: 7, like: denim}\n");
    const struct model_material *kes = model.materials, *fast = kes + 1, *own = kes + 2;
    const double second = 4.903325 / (0.04 * pow(0.01, 1 / 1.5)); /* n = 2 / 0.8 - 1 */
    ck_assert_int_eq(kes->model, MODEL_TRIANGLES);
    ck_assert_double_eq_tol(kes->density, 0.2, 1e-12);
    ck_assert_double_eq_tol(kes->stretch, 9806.65, 1e-4);
    ck_assert_double_eq_tol(model_weft(kes), second, 1e-6 * second);
    ck_assert_double_eq_tol(kes->shear, 28.094, 1e-3);
    ck_assert_double_eq_tol(kes->rigidity[0], 0.16 * 9.80665e-5, 1e-14);
    ck_assert_double_eq_tol(kes->rigidity[1], 0.11 * 9.80665e-5, 1e-14);
    ck_assert_double_eq(kes->stiffening.more[0][0], 0); /* LT 1: a straight line */
    ck_assert_double_eq_tol(kes->stiffening.at[1][1], 0.04 * pow(0.04, 1 / 1.5), 1e-10);
    ck_assert_double_eq_tol(kes->damping_stiffness, 0.5 / (M_PI * M_PI), 1e-9);
    ck_assert_double_eq_tol(model_damping_bending(kes), 0.06 / (2.5 * M_PI * M_PI * 0.075), 1e-9);
    ck_assert_double_eq(kes->friction, 0.2);
    ck_assert_double_eq(kes->thickness, 0.0008); /* 0.2 mm are lost by 50 gf/cm^2 */
    ck_assert_double_eq_tol(kes->pressure, 3 * 50 * 98.0665, 1e-4);
    ck_assert_double_eq_tol(fast->density, 0.2, 1e-12);
    ck_assert_double_eq_tol(fast->stretch, 980.665, 1e-6);
    ck_assert_double_eq_tol(model_weft(fast), 490.3325, 1e-6);
    ck_assert_double_eq_tol(fast->stiffening.at[1][0], 0.01, 1e-12);
    ck_assert_double_eq_tol(fast->stiffening.more[1][0], 95 * 0.980665 / 0.04 - 490.3325, 1e-6);
    ck_assert_double_eq_tol(fast->shear, 41, 1e-9);
    ck_assert_double_eq_tol(fast->rigidity[0], 1.5696e-5, 1e-12);
    ck_assert_double_eq(fast->friction, 0.4);
    ck_assert_double_eq(fast->thickness, 0.0005);
    ck_assert_double_eq_tol(fast->pressure, 1.5 * 100 * 98.0665, 1e-4);
    ck_assert_double_eq_tol(own->stretch, 9806.65, 1e-4);
    ck_assert_double_eq(own->shear, 7);
    ck_assert_double_eq_tol(own->rigidity[0], 1.954e-5, 1e-12);
    ck_assert_double_eq_tol(own->damping_stiffness, 2 / (8 * M_PI * M_PI), 1e-9);
}
