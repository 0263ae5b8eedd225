/* Scientific frames, read back by HDF5 itself. */
#include "cloth/output/hdf5.h"
#include "tests/cloth/output/sample.h"
#include "tests/support/unit.h"

#include <hdf5.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { POINTS = 5, TRIANGLES = 2, EDGES = 1, CELLS = TRIANGLES + EDGES };
static const uint32_t TRIANGLE[TRIANGLES][3] = {{0, 1, 2}, {2, 1, 3}}, EDGE[EDGES][2] = {{3, 4}};

static unsigned warnings;
static char warning[1200];

static void warn(const char *text)
{
    warnings++;
    snprintf(warning, sizeof warning, "%s", text);
}

/* A number that tells field, frame and place apart, no float. */
static double value(int field, uint64_t frame, size_t i)
{
    return 100 * field + 10 * (double)frame + (double)i / 3;
}

static void derive(void *context, struct output_state *state)
{
    *(unsigned *)context += 1;
    for (size_t i = 0; i < CELLS; i++)
        state->field[OUTPUT_STRAIN][i] = value(OUTPUT_STRAIN, state->frame, i);
    for (size_t i = 0; i < 3 * CELLS; i++)
        state->field[OUTPUT_STRESS][i] = value(OUTPUT_STRESS, state->frame, i);
}

static unsigned derived;
static struct output_hdf5_setup setup_of(bool is_double, uint32_t every, uint32_t level)
{
    struct output_hdf5_setup setup = {.folder = sample.folder,
                                      .n_points = POINTS,
                                      .n_triangles = TRIANGLES,
                                      .n_edges = EDGES,
                                      .triangle = TRIANGLE,
                                      .edge = EDGE,
                                      .is_double = is_double,
                                      .every = every,
                                      .level = level,
                                      .derive = derive,
                                      .context = &derived,
                                      .warn = warn};
    for (int i = 0; i < OUTPUT_FIELDS; i++)
        setup.wants[i] = true;
    return setup;
}

static void give(struct output_hdf5 *frames, uint64_t frame)
{
    struct output_state *state = output_hdf5_begin(frames, frame, (double)frame / 25);
    for (size_t i = 0; i < 3 * POINTS; i++) {
        state->position[i] = value(-1, frame, i);
        state->field[OUTPUT_VELOCITY][i] = value(OUTPUT_VELOCITY, frame, i);
        state->field[OUTPUT_FORCE][i] = value(OUTPUT_FORCE, frame, i);
    }
    for (int i = 0; i < POINTS; i++) {
        state->number[OUTPUT_BLOCK][i] = i - 1;
        state->number[OUTPUT_RANK][i] = i / 2;
    }
    output_hdf5_end(frames);
}

/* Writes those of the frames from one up to, not including, another that it takes. */
static void run_from(const struct output_hdf5_setup *setup, uint64_t first, uint64_t end)
{
    struct output_hdf5 *frames;
    UNIT_FINE(output_hdf5_open(&frames, setup, &error));
    for (uint64_t i = first; i < end; i++)
        if (output_hdf5_takes(frames, i))
            give(frames, i);
    UNIT_FINE(output_hdf5_close(&frames, &error));
    ck_assert_ptr_null(frames);
}

static void run(const struct output_hdf5_setup *setup, uint64_t n)
{
    run_from(setup, 0, n);
}

static void read_all(hid_t file, const char *name, hid_t type, size_t n, void *to)
{
    const hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
    ck_assert_msg(set >= 0, "%s is not there", name);
    const hid_t space = H5Dget_space(set);
    ck_assert_int_eq(H5Sget_simple_extent_npoints(space), (hssize_t)n);
    ck_assert_int_ge(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to), 0);
    H5Sclose(space);
    H5Dclose(set);
}

static void check_reals(hid_t file, const char *name, size_t n, int field, uint64_t frame,
                        bool is_double)
{
    double got[3 * POINTS];
    read_all(file, name, H5T_NATIVE_DOUBLE, n, got);
    for (size_t i = 0; i < n; i++) {
        const double want = value(field, frame, i);
        ck_assert_msg(is_double ? got[i] == want : got[i] == (double)(float)want, "%s", name);
    }
}

static void check_cells(hid_t file)
{
    static const int64_t CORNERS[] = {0, 1, 2, 2, 1, 3, 3, 4}, START[] = {0, 3, 6, 8};
    static const int64_t MIXED[] = {4, 0, 1, 2, 4, 2, 1, 3, 2, 2, 3, 4};
    static const unsigned char KIND[] = {5, 5, 3};
    static const char *const COUNT[] = {"NumberOfPoints", "NumberOfCells",
                                        "NumberOfConnectivityIds"};
    const int64_t counts[] = {POINTS, CELLS, 8};
    int64_t got[16];
    unsigned char kind[CELLS];
    for (int i = 0; i < 3; i++) {
        char name[64];
        snprintf(name, sizeof name, "VTKHDF/%s", COUNT[i]);
        read_all(file, name, H5T_NATIVE_INT64, 1, got);
        ck_assert_int_eq(got[0], counts[i]);
    }
    read_all(file, "VTKHDF/Connectivity", H5T_NATIVE_INT64, 8, got);
    ck_assert_mem_eq(got, CORNERS, sizeof CORNERS);
    read_all(file, "VTKHDF/Offsets", H5T_NATIVE_INT64, CELLS + 1, got);
    ck_assert_mem_eq(got, START, sizeof START);
    read_all(file, "XdmfCells", H5T_NATIVE_INT64, 12, got);
    ck_assert_mem_eq(got, MIXED, sizeof MIXED);
    read_all(file, "VTKHDF/Types", H5T_NATIVE_UCHAR, CELLS, kind);
    ck_assert_mem_eq(kind, KIND, sizeof KIND);
}

static void check_frame(uint64_t frame, bool is_double)
{
    int32_t number[POINTS];
    double time;
    const char *path = sample_at("hdf5/frame-%06u.vtkhdf", (unsigned)frame);
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    ck_assert_msg(file >= 0, "%s is not there", path);
    check_cells(file);
    check_reals(file, "VTKHDF/Points", 3 * POINTS, -1, frame, is_double);
    check_reals(file, "VTKHDF/PointData/velocity", 3 * POINTS, OUTPUT_VELOCITY, frame, is_double);
    check_reals(file, "VTKHDF/PointData/contact_force", 3 * POINTS, OUTPUT_FORCE, frame, is_double);
    check_reals(file, "VTKHDF/CellData/strain", CELLS, OUTPUT_STRAIN, frame, is_double);
    check_reals(file, "VTKHDF/CellData/stress", 3 * CELLS, OUTPUT_STRESS, frame, is_double);
    read_all(file, "VTKHDF/PointData/block", H5T_NATIVE_INT32, POINTS, number);
    ck_assert(number[0] == -1 && number[4] == 3);
    read_all(file, "VTKHDF/PointData/rank", H5T_NATIVE_INT32, POINTS, number);
    ck_assert(number[1] == 0 && number[4] == 2);
    read_all(file, "VTKHDF/FieldData/TimeValue", H5T_NATIVE_DOUBLE, 1, &time);
    ck_assert(time == (double)frame / 25);
    ck_assert_int_ge(H5Fclose(file), 0);
}

static void start(void)
{
    sample_make();
    warnings = derived = 0;
}

UNIT_FIXTURE(start, sample_free)

UNIT_TEST(comes_back)
{
    for (int i = 0; i < 4; i++) {
        const struct output_hdf5_setup setup = setup_of(i % 2, 1, i / 2 ? 6 : 0);
        run(&setup, 5);
        for (uint64_t frame = 0; frame < 5; frame++)
            check_frame(frame, i % 2);
    }
    ck_assert_uint_eq(derived, 4 * 5);
}

UNIT_TEST(every_third)
{
    char text[512];
    const struct output_hdf5_setup setup = setup_of(true, 3, 0);
    run(&setup, 7);
    ck_assert(sample_has(sample_at("hdf5/frame-000003.vtkhdf")) &&
              sample_has(sample_at("hdf5/frame-000006.vtkhdf")));
    ck_assert(!sample_has(sample_at("hdf5/frame-000001.vtkhdf")));
    sample_read(sample_at("cloth.vtkhdf.series"), text, sizeof text);
    ck_assert_str_eq(
        text, "{\n\"file-series-version\": \"1.0\",\n\"files\": [\n"
              "{\"name\": \"hdf5/frame-000000.vtkhdf\", \"time\": 0},\n"
              "{\"name\": \"hdf5/frame-000003.vtkhdf\", \"time\": 0.12},\n"
              "{\"name\": \"hdf5/frame-000006.vtkhdf\", \"time\": 0.23999999999999999}]\n}\n");
}

/* Equal frames are equal bytes, whenever they are written. */
UNIT_TEST(equal_frames_are_equal_files)
{
    char one[65536], two[65536];
    const struct output_hdf5_setup setup = setup_of(false, 1, 0);
    run(&setup, 1);
    const size_t n = sample_read(sample_at("hdf5/frame-000000.vtkhdf"), one, sizeof one);
    sleep(1); /* another second on the clock */
    run(&setup, 1);
    ck_assert_uint_eq(sample_read(sample_at("hdf5/frame-000000.vtkhdf"), two, sizeof two), n);
    ck_assert_mem_eq(one, two, n);
    ck_assert((double)n <= output_hdf5_bytes(&setup));
}

UNIT_TEST(replaces_an_earlier_run)
{
    const struct output_hdf5_setup setup = setup_of(false, 1, 0);
    run(&setup, 3);
    sample_write(sample_at("hdf5/frame-000007.vtkhdf.part"), "x", 1);
    sample_write(sample_at("hdf5/mine.txt"), "x", 1);
    run(&setup, 1);
    ck_assert(sample_has(sample_at("hdf5/frame-000000.vtkhdf")) &&
              !sample_has(sample_at("hdf5/frame-000001.vtkhdf")));
    ck_assert(!sample_has(sample_at("hdf5/frame-000007.vtkhdf.part")) &&
              sample_has(sample_at("hdf5/mine.txt")));
    UNIT_FINE(output_hdf5_forget(sample.folder, NULL, &error));
    ck_assert(!sample_has(sample_at("hdf5/frame-000000.vtkhdf")) &&
              !sample_has(sample_at("cloth.xmf")));
    ck_assert(sample_has(sample_at("hdf5/mine.txt")));
}

UNIT_TEST(leaves_what_is_not_ours)
{
    struct output_hdf5 *frames;
    const struct output_hdf5_setup setup = setup_of(false, 1, 0);
    sample_write(sample_at("cloth.xmf"), "mine", 4);
    UNIT_REFUSED(output_hdf5_open(&frames, &setup, &error), CLOTH_E_INPUT,
                 "cloth.xmf is in the way");
    UNIT_FINE(output_hdf5_forget(sample.folder, NULL, &error));
    ck_assert(sample_has(sample_at("cloth.xmf")));
}

enum { TEXT = 65536 };
static const char *const INDEXES[] = {"cloth.vtkhdf.series", "cloth.xmf"};

/* A run of five frames that is killed as it makes the next one, gone on with after `stay`: as one
 * of seven that is left alone. */
static void check_going_on(uint32_t every, uint64_t stay)
{
    static char alone[2][TEXT], text[TEXT];
    struct output_hdf5_setup setup = setup_of(true, every, 0);
    run(&setup, 7);
    for (int i = 0; i < 2; i++)
        sample_read(sample_at("%s", INDEXES[i]), alone[i], TEXT);
    run(&setup, 5);
    sample_write(sample_at("hdf5/frame-000005.vtkhdf.part"), "x", 1);
    sample_write(sample_at("hdf5/cloth.xmf.part"), "x", 1);
    const ino_t first = sample_stat(sample_at("hdf5/frame-000000.vtkhdf")).st_ino;
    setup.n_frames = &stay;
    run_from(&setup, stay, 7);
    for (int i = 0; i < 2; i++) {
        sample_read(sample_at("%s", INDEXES[i]), text, TEXT);
        ck_assert_str_eq(text, alone[i]);
    }
    for (uint64_t frame = 0; frame < 7; frame += every)
        check_frame(frame, true);
    ck_assert(stay == 0 || sample_stat(sample_at("hdf5/frame-000000.vtkhdf")).st_ino == first);
    ck_assert(!sample_has(sample_at("hdf5/frame-000005.vtkhdf.part")) &&
              !sample_has(sample_at("hdf5/cloth.xmf.part")));
}

UNIT_TEST(goes_on_with_an_earlier_run)
{
    for (uint64_t stay = 0; stay <= 5; stay++)
        for (uint32_t every = 1; every <= 2; every++)
            check_going_on(every, stay);
}

/* Frames that stay, and are not gone on with: a later scene does not ask for any. */
UNIT_TEST(keeps_frames_of_a_run_that_writes_no_more)
{
    static char alone[2][TEXT], text[TEXT];
    const uint64_t stay = 3;
    const struct output_hdf5_setup setup = setup_of(true, 1, 0);
    run(&setup, 3);
    for (int i = 0; i < 2; i++)
        sample_read(sample_at("%s", INDEXES[i]), alone[i], TEXT);
    run(&setup, 5);
    for (int again = 0; again < 2; again++)
        UNIT_FINE(output_hdf5_forget(sample.folder, &stay, &error));
    for (int i = 0; i < 2; i++) {
        sample_read(sample_at("%s", INDEXES[i]), text, TEXT);
        ck_assert_str_eq(text, alone[i]);
    }
    check_frame(2, true);
    ck_assert(!sample_has(sample_at("hdf5/frame-000003.vtkhdf")) &&
              !sample_has(sample_at("hdf5/cloth.xmf.part")));
}

/* An earlier run that had none is gone on with from the frame that is next. */
UNIT_TEST(begins_with_a_later_frame)
{
    char text[512];
    const uint64_t stay = 2;
    struct output_hdf5_setup setup = setup_of(true, 1, 0);
    setup.n_frames = &stay;
    run_from(&setup, 2, 3);
    sample_read(sample_at("%s", INDEXES[0]), text, sizeof text);
    ck_assert_str_eq(text, "{\n\"file-series-version\": \"1.0\",\n\"files\": [\n"
                           "{\"name\": \"hdf5/frame-000002.vtkhdf\", \"time\": "
                           "0.080000000000000002}]\n}\n");
}

static void refuse_to_go_on(const char *why)
{
    struct output_hdf5 *frames;
    const uint64_t stay = 2;
    struct output_hdf5_setup setup = setup_of(true, 1, 0);
    setup.n_frames = &stay;
    UNIT_REFUSED(output_hdf5_open(&frames, &setup, &error), CLOTH_E_INPUT, why);
    ck_assert(sample_has(sample_at("hdf5/frame-000001.vtkhdf")) &&
              sample_has(sample_at("hdf5/frame-000002.vtkhdf")));
}

/* A file that is to stay, and does not: nothing is removed. */
UNIT_TEST(refuses_a_changed_folder)
{
    char text[TEXT];
    const struct output_hdf5_setup setup = setup_of(true, 1, 0);
    run(&setup, 4);
    ck_assert_int_eq(unlink(sample_at("hdf5/frame-000000.vtkhdf")), 0);
    refuse_to_go_on("frame-000000.vtkhdf is gone: the folder was changed since the checkpoint");
    run(&setup, 4);
    ck_assert_int_eq(unlink(sample_at("cloth.xmf")), 0);
    refuse_to_go_on("cloth.xmf is gone: the folder was changed since the checkpoint");
    for (int i = 0; i < 2; i++) {
        run(&setup, 4);
        sample_read(sample_at("%s", INDEXES[i]), text, TEXT);
        const char *second = strstr(text, "000001"); /* the text is cut in its entry */
        sample_write(sample_at("%s", INDEXES[i]), text, (size_t)(second - text));
        refuse_to_go_on("is not whole: the folder was changed since the checkpoint");
    }
    run(&setup, 4);
    sample_write(sample_at("cloth.xmf"), "mine", 4);
    refuse_to_go_on("cloth.xmf is in the way");
}

/* A folder in the place of frame 1: the others are written, and it is said once. */
UNIT_TEST(goes_on_without_a_frame)
{
    struct output_hdf5 *frames;
    char text[512];
    const struct output_hdf5_setup setup = setup_of(true, 1, 0);
    UNIT_FINE(output_hdf5_open(&frames, &setup, &error));
    ck_assert_int_eq(mkdir(sample_at("hdf5/frame-000001.vtkhdf"), 0777), 0);
    for (uint64_t i = 0; i < 3; i++)
        give(frames, i);
    output_hdf5_wait(frames);
    ck_assert_uint_eq(warnings, 1);
    unit_says(warning, "hdf5/frame-000001.vtkhdf: Is a directory; the run goes "
                       "on without HDF5 frame 1");
    UNIT_REFUSED(output_hdf5_close(&frames, &error), CLOTH_E_IO,
                 "1 of 3 HDF5 frames were not written");
    check_frame(0, true);
    check_frame(2, true);
    ck_assert(!sample_has(sample_at("hdf5/frame-000001.vtkhdf.part")));
    sample_read(sample_at("cloth.vtkhdf.series"), text, sizeof text);
    ck_assert_ptr_null(strstr(text, "000001"));
    unit_says(text, "000002");
}

static int has_room_for_one(void *context, uint32_t n, struct cloth_error *error)
{
    (void)context;
    return n > 1 ? cloth_fail(error, CLOTH_E_IO, "no room") : CLOTH_OK;
}

/* Frames that the settler writes; also where it fails for another file, and settles nothing more.
 */
UNIT_LOOP(by_the_settler, 0, 2)
{
    struct output_hdf5 *frames;
    struct output_settler *settler;
    struct output_member other = {.settle = has_room_for_one};
    struct output_hdf5_setup setup = setup_of(true, 1, 0);
    UNIT_FINE(output_settler_open(&settler, &error));
    output_member_add(&other, settler, 0);
    setup.settler = settler;
    UNIT_FINE(output_hdf5_open(&frames, &setup, &error));
    for (uint32_t i = 0; i < 7; i++) {
        if (_i)
            output_member_wrote(&other, i + 1, NULL);
        give(frames, i);
    }
    ck_assert_int_eq(output_settler_close(&settler, NULL), _i ? CLOTH_E_IO : CLOTH_OK);
    UNIT_FINE(output_hdf5_close(&frames, &error));
    for (uint64_t frame = 0; frame < 7; frame++)
        check_frame(frame, true);
}
