/* ilsa-run from a scene to its result files. */
#include "csv.h"
#include "host.h"
#include "program.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* Seconds of injection into one soft layer: a few steps. The rate changes at 11.5 s. */
static const char scene[] = "[material]\nE = 9.5e9\nnu = 0.2\nmu = 0.1\nK_Ic = 1e6\nC_L = 1e-5\n"
                            "[mesh]\nnx = 25\nny = 23\ndx = 1\n"
                            "[stress]\nsigma = 7e6\n"
                            "[injection]\nschedule = 0:0.01, 11.5:0.02\n"
                            "[initial]\nradius = 5\n"
                            "[run]\nt_end = 14\noutput_times = 11, 14\ndt_initial = 0.3\n";

enum { NX = 25, NY = 23, CELLS = NX * NY };

static char output[8192];

/* The scene above in directory "out", run once for the tests that only read. */
static int run_once(void **state) {
    (void)state;
    program_write("scene.ini", scene);
    return program_run("ilsa-run scene.ini --out out", output, sizeof output);
}

static csv_table *result(const char *name) {
    char path[64];
    snprintf(path, sizeof path, "out/%s", name);
    return csv_read(program_path(path));
}

static double last(const csv_table *t, const char *column) {
    return csv_get(t, csv_rows(t) - 1, column);
}

static void assert_near(double value, double expected, double error) {
    if (!(fabs(value - expected) <= error))
        fail_msg("%.17g is not within %g of %.17g", value, error, expected);
}

static void closing_line(void **state) {
    (void)state;
    assert_int_equal(strncmp(output, "t = 14 in ", 10), 0);
    assert_non_null(strstr(output, "; results in out\n"));
}

static void history_header(void **state) {
    (void)state;
    static const char header[] =
        "t,dt,x_min,x_max,y_min,y_max,extent_x_min,extent_x_max,extent_y_min,extent_y_max,"
        "width_source,pressure_source,volume_injected,volume_fracture,volume_leaked,efficiency,"
        "cells,tip_cells,front_iterations,newton_iterations,krylov_iterations,"
        "elasticity_products,rejected,coarsened_x,coarsened_y,grown,wall_s\n";
    char *text = program_read("out/history.csv");
    assert_non_null(text);
    assert_int_equal(strncmp(text, header, strlen(header)), 0);
    free(text);
}

/* The steps follow each other and land on the output times, the change of rate and the end. */
static void history_times(void **state) {
    (void)state;
    csv_table *h = result("history.csv");
    size_t landed = 0;
    for (size_t i = 0; i < csv_rows(h); i++) {
        double t = csv_get(h, i, "t");
        landed += t == 11 || t == 11.5 || t == 14;
        if (i > 0)
            assert_near(csv_get(h, i - 1, "t") + csv_get(h, i, "dt"), t, 1e-12 * t);
    }
    assert_int_equal(landed, 3);
    assert_true(last(h, "t") == 14);
    assert_true(csv_get(h, 0, "dt") <= 0.3 * (1 + 1e-12));
    csv_free(h);
}

static void history_volumes(void **state) {
    (void)state;
    csv_table *h = result("history.csv");
    for (size_t i = 0; i < csv_rows(h); i++) {
        double t = csv_get(h, i, "t"), injected = csv_get(h, i, "volume_injected");
        double fracture = csv_get(h, i, "volume_fracture");
        assert_near(injected, 0.01 * t + 0.01 * fmax(0, t - 11.5), 1e-9 * injected);
        assert_near(fracture + csv_get(h, i, "volume_leaked"), injected, 1e-9 * injected);
        assert_near(csv_get(h, i, "efficiency"), fracture / injected, 1e-12);
    }
    csv_free(h);
}

static void history_extents(void **state) {
    (void)state;
    csv_table *h = result("history.csv");
    for (size_t i = 0; i < csv_rows(h); i++) {
        assert_true(csv_get(h, i, "extent_x_min") <= csv_get(h, i, "x_min"));
        assert_true(csv_get(h, i, "extent_y_max") >= csv_get(h, i, "y_max"));
        assert_near(csv_get(h, i, "x_min"), -csv_get(h, i, "x_max"), 1e-6);
        assert_true(csv_get(h, i, "cells") > csv_get(h, i, "tip_cells"));
        assert_true(csv_get(h, i, "newton_iterations") >= 1);
        assert_true(csv_get(h, i, "wall_s") >= 0);
    }
    csv_free(h);
}

/* Closed, around the source, as far out as the history says, colours that sum to 1. */
static void front_is_closed(void **state) {
    (void)state;
    csv_table *f = result("front_002.csv"), *h = result("history.csv");
    size_t end = csv_rows(f) - 1;
    double area = 0, x_max = 0;
    assert_true(end >= 20);
    assert_string_equal(csv_text(f, 0, "x"), csv_text(f, end, "x"));
    assert_string_equal(csv_text(f, 0, "y"), csv_text(f, end, "y"));
    for (size_t i = 0; i < end; i++) {
        double x = csv_get(f, i, "x"), y = csv_get(f, i, "y");
        area += 0.5 * (x * csv_get(f, i + 1, "y") - y * csv_get(f, i + 1, "x"));
        x_max = fmax(x_max, x);
        assert_true(csv_get(f, i, "V") >= 0);
        assert_near(csv_get(f, i, "N_k") + csv_get(f, i, "N_mt") + csv_get(f, i, "N_m"), 1, 3e-6);
    }
    assert_near(x_max, last(h, "extent_x_max"), 0.2);
    assert_near(area, acos(-1) * x_max * x_max, 0.05 * area);
    csv_free(f);
    csv_free(h);
}

static void survey_cells(void **state) {
    (void)state;
    csv_table *s = result("survey_001.csv");
    assert_true(csv_rows(s) >= 8);
    for (size_t i = 0; i < csv_rows(s); i++) {
        double k = csv_get(s, i, "N_k"), mt = csv_get(s, i, "N_mt");
        assert_true(csv_get(s, i, "s") > 0 && csv_get(s, i, "w") > 0);
        assert_near(k + mt + csv_get(s, i, "N_m"), 1, 3e-6);
        assert_near(csv_get(s, i, "triangle_x"), k + 0.5 * mt, 3e-6);
        assert_near(csv_get(s, i, "triangle_y"), 0.5 * sqrt(3) * mt, 3e-6);
    }
    csv_free(s);
}

static void lines_through_the_source(void **state) {
    (void)state;
    csv_table *x = result("line_x_002.csv"), *y = result("line_y_002.csv"),
              *h = result("history.csv");
    size_t middle = csv_rows(x) / 2;
    assert_near(csv_get(x, middle, "x"), 0, 0);
    assert_near(csv_get(x, middle, "width"), last(h, "width_source"), 1e-9);
    assert_near(csv_get(x, middle, "pressure"), last(h, "pressure_source"), 1);
    assert_int_equal(csv_rows(x), csv_rows(y));
    assert_true(csv_get(y, 0, "cell_kind") == 1 && csv_get(y, 0, "stress") == 7e6);
    csv_free(x);
    csv_free(y);
    csv_free(h);
}

static int digit_of(char c) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *at = c ? strchr(digits, c) : NULL;
    return at ? (int)(at - digits) : -1;
}

/* Decodes the array of a name in a .vti file: its bytes, without the count before them. */
static void *vti_array(const char *vti, const char *name, size_t bytes) {
    char mark[64];
    snprintf(mark, sizeof mark, "Name=\"%s\" format=\"binary\">\n", name);
    const char *text = strstr(vti, mark);
    assert_non_null(text);
    unsigned char *data = malloc(bytes + 16);
    size_t size = 0;
    unsigned bits = 0;
    int held = 0;
    for (text += strlen(mark); digit_of(*text) >= 0; text++) {
        bits = (bits << 6 | (unsigned)digit_of(*text)) & 0xFFFFFF;
        held += 6;
        if (held >= 8) {
            held -= 8;
            assert_true(size < bytes + 16);
            data[size++] = (unsigned char)(bits >> held);
        }
    }
    uint64_t count;
    memcpy(&count, data, sizeof count);
    assert_int_equal(count, bytes);
    assert_true(size >= bytes + 8);
    memmove(data, data + 8, bytes);
    return data;
}

/* Each tag is closed in its turn. */
static void assert_well_formed(const char *xml) {
    char open[8][32];
    int depth = 0;
    for (const char *tag = strchr(xml, '<'); tag; tag = strchr(tag + 1, '<')) {
        const char *end = strchr(tag, '>');
        assert_non_null(end);
        size_t length = strcspn(tag + 1, " >/");
        if (tag[1] == '?' || tag[1] == '!' || end[-1] == '/')
            continue;
        if (tag[1] == '/') {
            assert_true(depth > 0);
            depth--;
            assert_int_equal(strncmp(open[depth], tag + 2, strlen(open[depth])), 0);
            continue;
        }
        assert_true(depth < 8 && length < sizeof open[0]);
        memcpy(open[depth], tag + 1, length);
        open[depth++][length] = '\0';
    }
    assert_int_equal(depth, 0);
}

static void vti_is_well_formed(void **state) {
    (void)state;
    char *vti = program_read("out/fields_002.vti"), *pvd = program_read("out/run.pvd");
    assert_non_null(vti);
    assert_non_null(pvd);
    assert_well_formed(vti);
    assert_non_null(strstr(vti, "<ImageData WholeExtent=\"0 25 0 23 0 0\" Origin=\"-12.5 -11.5 0\" "
                                "Spacing=\"1 1 1\">"));
    assert_well_formed(pvd);
    assert_non_null(strstr(pvd, "<DataSet timestep=\"11\" part=\"0\" file=\"fields_001.vti\"/>"));
    assert_non_null(strstr(pvd, "<DataSet timestep=\"14\" part=\"0\" file=\"fields_002.vti\"/>"));
    free(vti);
    free(pvd);
}

/* Its fields agree with the history and with each other. */
static void vti_fields(void **state) {
    (void)state;
    char *vti = program_read("out/fields_002.vti");
    assert_non_null(vti);
    double *width = vti_array(vti, "width", CELLS * sizeof(double));
    double *pressure = vti_array(vti, "pressure", CELLS * sizeof(double));
    double *stress = vti_array(vti, "stress", CELLS * sizeof(double));
    double *trigger = vti_array(vti, "trigger_time", CELLS * sizeof(double));
    unsigned char *kind = vti_array(vti, "cell_kind", CELLS);
    csv_table *h = result("history.csv");
    double volume = 0;
    int cells = 0;
    for (int c = 0; c < CELLS; c++) {
        volume += width[c];
        cells += kind[c] != 0;
        assert_true(kind[c] <= 3 && stress[c] == 7e6);
        assert_true(kind[c] ? width[c] > 0 : width[c] == 0 && pressure[c] == 0);
        assert_true(kind[c] == 0 ? isnan(trigger[c]) : kind[c] == 1 || trigger[c] <= 14);
    }
    assert_near(volume, last(h, "volume_fracture"), 1e-9 * volume);
    assert_int_equal(cells, (int)last(h, "cells"));
    assert_near(width[CELLS / 2], last(h, "width_source"), 1e-12);
    csv_free(h);
    free(vti);
    free(width);
    free(pressure);
    free(stress);
    free(trigger);
    free(kind);
}

static void assert_says(const char *name, const char *const *texts, size_t count) {
    char *text = program_read(name);
    assert_non_null(text);
    for (size_t i = 0; i < count; i++)
        if (!strstr(text, texts[i]))
            fail_msg("%s does not say \"%s\":\n%s", name, texts[i], text);
    free(text);
}

static void summary_says(void **state) {
    (void)state;
    static const char *const texts[] = {
        "ended                 done\n",
        "mesh                  25 x 23 cells of 1 x 1\n",
        "modelled              elasticity, viscous flow, toughness, leak-off\n",
        "left out              variation of stress (uniform)\n",
        "tip                   full asymptote\n",
        "solved                one quarter",
        "time                  14\n",
        "rejected ",
        "Newton iterations ",
        "elasticity products ",
        "  preconditioner ",
        "  start and output "};
    assert_says("out/summary.txt", texts, sizeof texts / sizeof *texts);
}

/* Nothing but whole files, two outputs' worth. */
static void files_of_a_run(void **state) {
    (void)state;
    assert_int_equal(program_run("ls out", output, sizeof output), 0);
    assert_string_equal(output, "fields_001.vti\nfields_002.vti\nfront_001.csv\nfront_002.csv\n"
                                "history.csv\nline_x_001.csv\nline_x_002.csv\nline_y_001.csv\n"
                                "line_y_002.csv\nplot.gp\nrun.pvd\nsummary.txt\nsurvey_001.csv\n"
                                "survey_002.csv\n");
}

/* The scene with one of its lines replaced. */
static void write_scene(const char *line, const char *other) {
    char text[2048];
    const char *at = strstr(scene, line);
    assert_non_null(at);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - scene), scene, other, at + strlen(line));
    program_write("other.ini", text);
}

static int run_other(const char *options) {
    char command[256];
    snprintf(command, sizeof command, "ilsa-run other.ini %s", options);
    return program_run(command, output, sizeof output);
}

/* Another tip model is named, and is not the same fracture. */
static void tip_model_is_named(void **state) {
    (void)state;
    static const char *const texts[] = {"tip                   toughness and viscosity alone\n"};
    write_scene("[run]\n", "[run]\ntip = toughness-viscosity\n");
    assert_int_equal(run_other("--out poorer --quiet"), 0);
    assert_says("poorer/summary.txt", texts, 1);
    assert_int_not_equal(
        program_run("cmp -s out/history.csv poorer/history.csv", output, sizeof output), 0);
}

static void nothing_modelled_in_vain(void **state) {
    (void)state;
    static const char *const texts[] = {
        "modelled              elasticity, viscous flow\n",
        "left out              toughness (zero)  leak-off (zero)  variation of stress (uniform)\n"};
    write_scene("K_Ic = 1e6\nC_L = 1e-5\n", "K_Ic = 0\nC_L = 0\n");
    assert_int_equal(run_other("--out plain --quiet"), 0);
    assert_says("plain/summary.txt", texts, 2);
    char *vti = program_read("plain/fields_001.vti");
    assert_non_null(vti);
    assert_null(strstr(vti, "trigger_time\""));
    free(vti);
}

static void options_are_heeded(void **state) {
    (void)state;
    static const char *const level[] = {"level                 1 ", "threads               2\n"};
    write_scene("t_end = 14\noutput_times = 11, 14\n", "t_end = 11\n");
    assert_int_equal(run_other("--level 1 --threads 2 --quiet --out=deep/er/level"), 0);
    assert_string_equal(output, "");
    assert_says("deep/er/level/summary.txt", level, 2);
    assert_int_equal(run_other("--quiet"), 0);
    assert_true(program_exists("other.out/history.csv"));
}

/* Results of a longer run before do not stay among the new ones; what is not ours does. */
static void earlier_results_go(void **state) {
    (void)state;
    write_scene("t_end = 14\noutput_times = 11, 14\n", "t_end = 11\n");
    assert_int_equal(program_run("mkdir again && cd again && touch front_002.csv fields_1000.vti "
                                 "summary.txt front_notes.csv front_2.csv",
                                 output, sizeof output),
                     0);
    assert_int_equal(run_other("--out again"), 0);
    assert_false(program_exists("again/front_002.csv"));
    assert_false(program_exists("again/fields_1000.vti"));
    assert_true(program_exists("again/front_notes.csv"));
    assert_true(program_exists("again/front_2.csv"));
}

static void mesh_edge_is_told(void **state) {
    (void)state;
    write_scene("t_end = 14\noutput_times = 11, 14\n", "t_end = 600\n");
    assert_int_equal(run_other("--out edge"), 1);
    assert_int_equal(strncmp(output, "ilsa-run: failed at t = ", 24), 0);
    assert_non_null(strstr(output, " of 600: "));
    assert_non_null(strstr(output, "; what was reached is in edge\n"
                                   "other.ini:9: [mesh] ny: the fracture has come to the edge of "
                                   "the mesh, x -"));
    assert_non_null(strstr(output, "; give more cells, or [run] coarsen = yes\n"));
    static const char *const texts[] = {"ended                 failed at t = ",
                                        "\n                      other.ini:9: [mesh] ny: "};
    assert_says("edge/summary.txt", texts, 2);
    csv_table *h = csv_read(program_path("edge/history.csv"));
    assert_true(last(h, "extent_x_max") > 8);
    csv_free(h);
    assert_true(program_exists("edge/front_001.csv"));
}

static void mesh_edge_is_coarsened(void **state) {
    (void)state;
    write_scene("nx = 25\nny = 23\ndx = 1\n", "nx = 51\nny = 49\ndx = 0.5\n");
    assert_int_equal(program_run("sed -i -e 's/t_end = 14/t_end = 120/' "
                                 "-e 's/^output_times.*/coarsen = yes/' other.ini",
                                 output, sizeof output),
                     0);
    assert_int_equal(run_other("--out coarse --quiet"), 0);
    static const char *const texts[] = {
        "51 x 49 cells of 1 x 1, coarsened 1 times from 0.5 x 0.5\n"};
    assert_says("coarse/summary.txt", texts, 1);
    static const char *const plot[] = {"cell_dx = \"1 \"\n"};
    assert_says("coarse/plot.gp", plot, 1);
    csv_table *h = csv_read(program_path("coarse/history.csv"));
    double x = 0, y = 0, grown = 0;
    for (size_t i = 0; i < csv_rows(h); i++) {
        x += csv_get(h, i, "coarsened_x");
        y += csv_get(h, i, "coarsened_y");
        grown += csv_get(h, i, "grown");
    }
    assert_true(x == 1 && y == 1 && grown == 0);
    csv_free(h);
}

/* A mesh of few cells gets more of them; the fields are those of the mesh of their time. */
static void mesh_edge_is_grown(void **state) {
    (void)state;
    write_scene("t_end = 14\noutput_times = 11, 14\n",
                "t_end = 120\noutput_times = 11, 120\ncoarsen = yes\n");
    assert_int_equal(run_other("--out more --quiet"), 0);
    static const char *const texts[] = {
        "49 x 45 cells of 1 x 1, grown 1 times from 25 x 23 cells\n"};
    assert_says("more/summary.txt", texts, 1);
    static const char *const small[] = {"\"0 25 0 23 0 0\""};
    static const char *const large[] = {"\"0 49 0 45 0 0\""};
    assert_says("more/fields_001.vti", small, 1);
    assert_says("more/fields_002.vti", large, 1);
}

static void two_sources(void **state) {
    (void)state;
    write_scene("[initial]\n", "[injection.2]\nschedule = 0:0, 12:0.03\nx = 2\n[initial]\n");
    assert_int_equal(run_other("--out two --quiet"), 0);
    csv_table *h = csv_read(program_path("two/history.csv"));
    double injected = 0.01 * 11.5 + 0.02 * 2.5 + 0.03 * 2;
    assert_near(last(h, "volume_injected"), injected, 1e-9 * injected);
    assert_true(last(h, "extent_x_max") > -last(h, "extent_x_min"));
    csv_free(h);
}

/* Which source, where it stands in the file and when, and not that there is no fracture. */
static void source_outside_is_named(void **state) {
    (void)state;
    write_scene("[initial]\n", "[injection.2]\nrate = 0\n[injection.3]\n"
                               "schedule = 0:0, 12:0.03\nx = 9\ny = -2\n[initial]\n");
    assert_int_equal(run_other("--out off --quiet"), 1);
    assert_string_equal(output, "ilsa-run: failed at t = 12 of 14: a source injects outside the "
                                "fracture; what was reached is in off\n"
                                "other.ini:18: injection.3 at (9, -2) is not in the fracture at "
                                "time 12 s, when it injects 0.03\n");
    static const char *const texts[] = {"\n                      other.ini:18: injection.3 at "};
    assert_says("off/summary.txt", texts, 1);
}

/* Between barriers the footprint is too narrow for larger cells: the mesh becomes longer. */
static void narrow_fracture_gets_a_longer_mesh(void **state) {
    (void)state;
    write_scene("sigma = 7e6\n", "sigma = 12e6, 7e6, 12e6\ninterfaces = -2.5, 2.5\n");
    assert_int_equal(program_run("sed -i -e 's/radius = 5/radius = 2.5/' -e 's/t_end = 14/t_end = "
                                 "60/' -e 's/^output_times.*/coarsen = yes/' "
                                 "-e 's/^schedule.*/rate = 0.01/' other.ini",
                                 output, sizeof output),
                     0);
    assert_int_equal(run_other("--out narrow --quiet"), 0);
    static const char *const texts[] = {" x 23 cells of 1 x 1, grown "};
    assert_says("narrow/summary.txt", texts, 1);
}

/* Neither more cells nor larger ones: nine cells a side, and no leave for more. */
static void mesh_that_cannot_be_enlarged_is_told(void **state) {
    (void)state;
    write_scene("nx = 25\nny = 23\ndx = 1\n", "nx = 9\nny = 9\ndx = 2.4\ncells_max = 81\n");
    assert_int_equal(program_run("sed -i -e 's/t_end = 14/t_end = 600/' "
                                 "-e 's/^output_times.*/coarsen = yes/' other.ini",
                                 output, sizeof output),
                     0);
    assert_int_equal(run_other("--out full --quiet"), 1);
    assert_non_null(strstr(output, "other.ini:8: [mesh] nx: the fracture has come to the edge of "
                                   "the mesh, x -"));
    assert_non_null(
        strstr(output, "; give larger cells, or a larger cells_max for more of them\n"));
}

/* Two lines. A solver that has learned to run this scene leaves nothing to say. */
static void stall_is_placed(void **state) {
    (void)state;
    write_scene("E = 9.5e9\n", "E = 1e59\n");
    int status = run_other("--out stalled --quiet");
    const char *where = strstr(output, "\nwhere: t = ");
    if (!where) {
        skip();
        return;
    }
    assert_int_equal(status, 1);
    assert_non_null(strstr(where, " steps refused at the end, "));
    assert_non_null(strstr(where, " cells closed; fracture x -"));
    assert_non_null(strstr(where, " on cells of 1 x 1\ntry: other.ini:8: [mesh] nx = 51, ny = 47, "
                                  "dx = 0.5, dy = 0.5: cells half as large\n"));
}

/* A log that mirrors itself is solved as a quarter; as fine layers it goes on in new cells. */
static void stress_log_goes_on_in_new_cells(void **state) {
    (void)state;
    static const char *const texts[] = {
        "\nstress                log.csv: 5 rows, y -40 .. 40; beyond, the end values\n",
        "solved                one quarter"};
    write_scene("sigma = 7e6\n", "profile = log.csv\n");
    assert_int_equal(program_run("sed -i -e 's/^t_end.*/t_end = 120/' "
                                 "-e 's/^output_times.*/coarsen = yes/' other.ini",
                                 output, sizeof output),
                     0);
    program_write("log.csv", "y (m), sigma (Pa)\n-40, 7.3e6\n-7.3, 7.1e6\n0, 7e6\n"
                             "7.3, 7.1e6\n40, 7.3e6\n");
    assert_int_equal(run_other("--out log --quiet"), 0);
    assert_says("log/summary.txt", texts, 2);
    csv_table *y = csv_read(program_path("log/line_y_001.csv"));
    for (size_t i = 0; i < csv_rows(y); i++) {
        double low = fabs(csv_get(y, i, "y")) - 1, high = low + 2;
        double slope = low >= 7.3 ? 0.2e6 / 32.7 : 0.1e6 / 7.3;
        if (low >= 0 && (low >= 7.3 || high <= 7.3))
            assert_near(csv_get(y, i, "stress"),
                        (low >= 7.3 ? 7.1e6 + slope * (low + 1 - 7.3) : 7e6 + slope * (low + 1)),
                        1e-3);
    }
    assert_near(csv_get(y, 0, "y") - csv_get(y, 1, "y"), -1, 0);
    csv_free(y);
    static const char *const plot[] = {"interfaces = \"\"\n"};
    assert_says("log/plot.gp", plot, 1);
}

static int has_row(const char *name) {
    char *text = program_read(name);
    const char *row = text ? strchr(text, '\n') : NULL;
    int found = row && strchr(row + 1, '\n');
    free(text);
    return found;
}

/* Until a run into the directory has taken a step, or has come to its end. */
static void wait_for_step(const char *directory) {
    char part[64], whole[64];
    struct timespec pause = {0, 5000000};
    snprintf(part, sizeof part, "%s/history.csv.part", directory);
    snprintf(whole, sizeof whole, "%s/history.csv", directory);
    for (int i = 0; i < 12000 && !has_row(part) && !has_row(whole); i++)
        nanosleep(&pause, NULL);
    if (!has_row(part) && !has_row(whole))
        fail_msg("no step in %s after a minute", directory);
}

/* Runs a scene until its first step is done. */
static pid_t begun(const char *scene_path, const char *directory) {
    pid_t child = fork();
    if (child == 0) {
        if (!freopen(program_path("stderr.txt"), "w", stderr))
            _exit(99);
        execl(program_ilsa_run(), "ilsa-run", scene_path, "--quiet", "--out",
              program_path(directory), (char *)NULL);
        _exit(99);
    }
    assert_true(child > 0);
    wait_for_step(directory);
    return child;
}

static int exit_status(pid_t child) {
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

/* Runs a scene, sends it a signal after its first step; its exit status. */
static int interrupted(const char *scene_path, int number, const char *directory) {
    pid_t child = begun(scene_path, directory);
    kill(child, number);
    return exit_status(child);
}

static void write_long_scene(void) {
    write_scene("t_end = 14\noutput_times = 11, 14\n", "t_end = 1e9\ncoarsen = yes\ndt_max = 1\n");
}

static void assert_ended_well(const char *directory, const char *message) {
    char name[64], command[64];
    char *said = program_read("stderr.txt");
    assert_non_null(said);
    assert_int_equal(strncmp(said, message, strlen(message)), 0);
    assert_non_null(strstr(said, " of 1000000000; what was reached is in "));
    free(said);
    snprintf(name, sizeof name, "%s/history.csv", directory);
    csv_table *h = csv_read(program_path(name));
    assert_true(csv_rows(h) >= 1);
    csv_free(h);
    snprintf(command, sizeof command, "ls %s", directory);
    assert_int_equal(program_run(command, output, sizeof output), 0);
    assert_string_equal(output, "fields_001.vti\nfront_001.csv\nhistory.csv\nline_x_001.csv\n"
                                "line_y_001.csv\nplot.gp\nrun.pvd\nsummary.txt\nsurvey_001.csv\n");
}

static void control_c(void **state) {
    (void)state;
    write_long_scene();
    assert_int_equal(interrupted(program_path("other.ini"), SIGINT, "int"), 130);
    assert_ended_well("int", "ilsa-run: stopped by Ctrl-C at t = ");
}

static void terminated(void **state) {
    (void)state;
    write_long_scene();
    assert_int_equal(interrupted(program_path("other.ini"), SIGTERM, "term"), 143);
    assert_ended_well("term", "ilsa-run: stopped by SIGTERM at t = ");
}

/* Each scene of the paper is accepted and takes its first step. */
static void shipped_scenes_start(void **state) {
    (void)state;
    static const char *const names[] = {
        "radial_fig4a",      "radial_fig4b",       "radial_fig4c",       "radial_fig5a",
        "radial_fig5b",      "radial_fig5c",       "radial_fig5d",       "symmetric_phi1e-4",
        "symmetric_phi1e-2", "symmetric_phi1",     "drop_phi1e-4",       "drop_phi1e-2",
        "drop_phi1",         "asymmetric_phi1e-4", "asymmetric_phi1e-2", "asymmetric_phi1"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[64];
        snprintf(path, sizeof path, "examples/scenes/%s.ini", names[i]);
        int status = interrupted(path, SIGINT, names[i]);
        if (status != 130 && status != 0)
            fail_msg("%s ended with status %d", path, status);
    }
}

/* A file that cannot be written: said so, and nothing left of it. */
static void full_disk(const char *file) {
    char command[128], message[128];
    program_write("other.ini", scene);
    snprintf(command, sizeof command, "rm -rf full; mkdir full; ln -s /dev/full full/%s.part",
             file);
    assert_int_equal(program_run(command, output, sizeof output), 0);
    assert_int_equal(run_other("--out full"), 1);
    snprintf(message, sizeof message, "ilsa-run: full/%s: No space left on device\n", file);
    if (!strstr(output, message))
        fail_msg("\"%s\" is not in \"%s\"", message, output);
    snprintf(command, sizeof command, "ls full/%s full/*.part", file);
    assert_int_not_equal(program_run(command, output, sizeof output), 0);
    assert_null(strstr(output, "\nfull/"));
}

static void disk_is_full(void **state) {
    (void)state;
    if (access("/dev/full", W_OK) != 0)
        skip();
    full_disk("history.csv");
    full_disk("fields_001.vti");
    full_disk("front_002.csv");
    full_disk("summary.txt");
}

/* Runs the scene in other.ini within a shell command, %s of which is the program. */
static int run_within(const char *format) {
    char command[4600];
    snprintf(command, sizeof command, format, program_ilsa_run());
    return program_run(command, output, sizeof output);
}

static void assert_output(const char *part) {
    if (!strstr(output, part))
        fail_msg("\"%s\" is not in \"%s\"", part, output);
}

/* Files may take 2 kB: not the fields, and not all of the history, whose first rows stay whole. */
static void space_runs_out(void **state) {
    (void)state;
    write_scene("t_end = 14\n", "t_end = 14\ndt_max = 0.1\n");
    assert_int_equal(run_within("ulimit -f 4; '%s' other.ini --out small"), 1);
    assert_output("ilsa-run: small/history.csv: File too large\n");
    assert_output("ilsa-run: failed at t = ");
    assert_output(": a result file could not be written; what was reached is in small\n");
    char *text = program_read("small/history.csv");
    assert_non_null(text);
    assert_true(strlen(text) <= 2048 && text[strlen(text) - 1] == '\n');
    free(text);
    csv_table *h = csv_read(program_path("small/history.csv"));
    assert_true(csv_rows(h) >= 2 && last(h, "wall_s") >= 0);
    csv_free(h);
    assert_int_equal(program_run("ls small", output, sizeof output), 0);
    assert_string_equal(output, "history.csv\nsummary.txt\n");
}

/* Seen at the next step, not at the end of a night. */
static void output_is_removed(const char *what, const char *directory) {
    char command[64];
    write_long_scene();
    pid_t child = begun(program_path("other.ini"), directory);
    snprintf(command, sizeof command, "rm -r %s", what);
    assert_int_equal(program_run(command, output, sizeof output), 0);
    assert_int_equal(exit_status(child), 1);
    char *said = program_read("stderr.txt");
    assert_non_null(said);
    assert_non_null(strstr(said, "/history.csv: No such file or directory\n"));
    assert_non_null(strstr(said, "ilsa-run: failed at t = "));
    free(said);
}

static void history_is_removed(void **state) {
    (void)state;
    output_is_removed("gone/history.csv.part", "gone");
    assert_int_equal(program_run("ls gone", output, sizeof output), 0);
    assert_string_equal(output, "fields_001.vti\nfront_001.csv\nline_x_001.csv\nline_y_001.csv\n"
                                "plot.gp\nrun.pvd\nsummary.txt\nsurvey_001.csv\n");
}

static void directory_is_removed(void **state) {
    (void)state;
    output_is_removed("away", "away");
    assert_false(program_exists("away"));
}

/* The results are whole, the closing line is not, and that is told. */
static void closing_line_is_lost(void **state) {
    (void)state;
    static const char *const done[] = {"ended                 done\n"};
    program_write("other.ini", scene);
    assert_int_equal(run_within("'%s' other.ini --out shut 2>said >&-; s=$?; cat said; exit $s"),
                     1);
    assert_string_equal(output, "ilsa-run: standard output: Bad file descriptor\n");
    assert_says("shut/summary.txt", done, 1);
    assert_int_equal(run_within("{ '%s' other.ini --out pipe 2>said; echo $? >>said; } | :; "
                                "sleep 0.1; cat said"),
                     0);
    assert_string_equal(output, "ilsa-run: standard output: Broken pipe\n1\n");
    assert_says("pipe/summary.txt", done, 1);
    if (access("/dev/full", W_OK) != 0)
        return;
    assert_int_equal(run_within("'%s' other.ini --out full 2>said >/dev/full; s=$?; "
                                "cat said; exit $s"),
                     1);
    assert_output("ilsa-run: standard output: No space left on device\n");
    assert_int_equal(run_within("'%s' --help 2>said >/dev/full; s=$?; cat said; exit $s"), 1);
    assert_output("ilsa-run: standard output: No space left on device\n");
}

/* No result file takes the place of a stream that the caller has closed. */
static void closed_streams_are_not_written_to(void **state) {
    (void)state;
    static const char header[] = "scene                 other.ini\n";
    program_write("other.ini", scene);
    assert_int_equal(run_within("('%s' other.ini --out mute --quiet <&- >&- 2>&-)"), 0);
    assert_int_equal(program_run("cmp out/front_002.csv mute/front_002.csv && "
                                 "cmp out/fields_002.vti mute/fields_002.vti",
                                 output, sizeof output),
                     0);
    write_scene("t_end = 14\noutput_times = 11, 14\n", "t_end = 600\n");
    assert_int_equal(run_within("('%s' other.ini --out mute <&- >&- 2>&-)"), 1);
    char *text = program_read("mute/summary.txt");
    assert_non_null(text);
    assert_int_equal(strncmp(text, header, strlen(header)), 0);
    assert_null(strstr(text, "ilsa-run:"));
    free(text);
}

/* In ways that hold for the super-user too. */
static void directory_cannot_be_written(void **state) {
    (void)state;
    static const char start[] = "ilsa-run: /proc/history.csv: ";
    program_write("other.ini", scene);
    assert_int_equal(run_other("--out /proc"), 1);
    assert_int_equal(strncmp(output, start, strlen(start)), 0);
    assert_int_equal(run_other("--out /proc/none"), 1);
    assert_string_equal(output, "ilsa-run: /proc/none: No such file or directory\n");
    if (geteuid() == 0)
        return;
    assert_int_equal(program_run("mkdir -m 555 locked", output, sizeof output), 0);
    assert_int_equal(run_other("--out locked"), 1);
    assert_string_equal(output, "ilsa-run: locked/history.csv: Permission denied\n");
}

static void directory_cannot_be_made(void **state) {
    (void)state;
    program_write("other.ini", scene);
    assert_int_equal(run_other("--out scene.ini/sub"), 1);
    assert_string_equal(output, "ilsa-run: scene.ini/sub: Not a directory\n");
    assert_int_equal(run_other("--out scene.ini"), 1);
    assert_string_equal(output, "ilsa-run: scene.ini: Not a directory\n");
}

/* On a terminal: time, step, percent, time left. script(1) makes one, where it can. */
static void progress_on_a_terminal(void **state) {
    (void)state;
    char command[4096];
    if (program_run("script -qec true /dev/null </dev/null", output, sizeof output) != 0)
        skip();
    write_scene("t_end = 14\noutput_times = 11, 14\n", "t_end = 60\ncoarsen = yes\ndt_max = 0.2\n");
    snprintf(command, sizeof command, "script -qec '%s other.ini --out term' /dev/null </dev/null",
             program_ilsa_run());
    assert_int_equal(program_run(command, output, sizeof output), 0);
    assert_non_null(strstr(output, " of 60   step "));
    assert_non_null(strstr(output, " %   "));
}

static void figures_are_drawn(void **state) {
    (void)state;
    char command[600], here[300];
    if (program_run("command -v gnuplot", output, sizeof output) != 0)
        skip();
    assert_non_null(getcwd(here, sizeof here));
    snprintf(command, sizeof command, "'%s/examples/figures.sh' out", here);
    assert_int_equal(program_run(command, output, sizeof output), 0);
    assert_string_equal(output, "figures in out: footprint, triangle, lines, history (.png, "
                                ".svg)\n");
    assert_int_equal(program_run("ls out/*.png out/*.svg", output, sizeof output), 0);
    assert_string_equal(output, "out/footprint.png\nout/footprint.svg\nout/history.png\n"
                                "out/history.svg\nout/lines.png\nout/lines.svg\n"
                                "out/triangle.png\nout/triangle.svg\n");
    snprintf(command, sizeof command, "'%s/examples/figures.sh' .", here);
    assert_int_equal(program_run(command, output, sizeof output), 1);
}

/* The figures of the paper from nine runs, here nine times the same. */
static void paper_figures_are_drawn(void **state) {
    (void)state;
    char command[600], here[300];
    if (program_run("command -v gnuplot", output, sizeof output) != 0)
        skip();
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(
        program_run("mkdir paper && cd paper && for g in symmetric asymmetric drop; do "
                    "for p in 1e-4 1e-2 1; do ln -s ../out ${g}_phi$p; done; done",
                    output, sizeof output),
        0);
    snprintf(command, sizeof command, "'%s/examples/paper_figures.sh' paper", here);
    if (host_long()) {
        assert_int_equal(program_run(command, output, sizeof output), 0);
        assert_string_equal(output, "figures in paper: fig08 to fig20 (.png, .svg)\n");
        assert_int_equal(program_run("ls paper/*.png paper/*.svg | wc -l", output, sizeof output),
                         0);
        assert_int_equal(strtol(output, NULL, 10), 26);
    }
    assert_int_equal(program_run("rm paper/symmetric_phi1e-4", output, sizeof output), 0);
    assert_int_equal(program_run(command, output, sizeof output), 1);
    assert_non_null(strstr(output, "paper/symmetric_phi1e-4/plot.gp is missing"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closing_line),
        cmocka_unit_test(history_header),
        cmocka_unit_test(history_times),
        cmocka_unit_test(history_volumes),
        cmocka_unit_test(history_extents),
        cmocka_unit_test(front_is_closed),
        cmocka_unit_test(survey_cells),
        cmocka_unit_test(lines_through_the_source),
        cmocka_unit_test(vti_is_well_formed),
        cmocka_unit_test(vti_fields),
        cmocka_unit_test(summary_says),
        cmocka_unit_test(files_of_a_run),
        cmocka_unit_test(figures_are_drawn),
        cmocka_unit_test(paper_figures_are_drawn),
        cmocka_unit_test(tip_model_is_named),
        cmocka_unit_test(nothing_modelled_in_vain),
        cmocka_unit_test(options_are_heeded),
        cmocka_unit_test(earlier_results_go),
        cmocka_unit_test(mesh_edge_is_told),
        cmocka_unit_test(mesh_edge_is_coarsened),
        cmocka_unit_test(mesh_edge_is_grown),
        cmocka_unit_test(two_sources),
        cmocka_unit_test(source_outside_is_named),
        cmocka_unit_test(narrow_fracture_gets_a_longer_mesh),
        cmocka_unit_test(mesh_that_cannot_be_enlarged_is_told),
        cmocka_unit_test(stall_is_placed),
        cmocka_unit_test(stress_log_goes_on_in_new_cells),
        cmocka_unit_test(control_c),
        cmocka_unit_test(terminated),
        cmocka_unit_test(shipped_scenes_start),
        cmocka_unit_test(disk_is_full),
        cmocka_unit_test(space_runs_out),
        cmocka_unit_test(history_is_removed),
        cmocka_unit_test(directory_is_removed),
        cmocka_unit_test(closing_line_is_lost),
        cmocka_unit_test(closed_streams_are_not_written_to),
        cmocka_unit_test(directory_cannot_be_made),
        cmocka_unit_test(directory_cannot_be_written),
        cmocka_unit_test(progress_on_a_terminal),
    };
    return cmocka_run_group_tests_name("run", tests, run_once, NULL);
}
