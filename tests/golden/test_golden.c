/* The G-code of a few jobs is what it was when the table was written, byte by byte, for any number
 * of threads and in any build. A change that means to change it renews the table:
 *
 *     ISO_GOLDEN_WRITE=1 test-golden
 */
#include "job/checks.h"
#include "job/solids.h"

typedef struct golden_job {
    const char *name;
    void (*make)(shape *s);
    const char *settings;
} golden_job;

static const golden_job jobs[] = {
    {"cube", solid_cube, ""},
    {"cavity", solid_cavity,
     "fill_pattern = grid\nlayer_heights = 0.3,0.2,0.1,0.25\nuse_relative_e_distances = 0\n"
     "external_perimeters_first = 1\nretract_lift = 0.4"},
    {"torus", solid_torus, "fill_density = 100%\nlayer_height = 0.2\nperimeters = 2\nskirts = 2"},
    {"vase", solid_vase,
     "layer_height = 0.25\nfill_angle = 30\nfill_density = 35%\ngcode_resolution = 0.005"},
};

enum { JOBS = sizeof jobs / sizeof *jobs };

/* Whole micrometres, so that a last bit of libm's sine can't show. */
static void round_corners(shape *s) {
    for (int64_t i = 0; i < 9 * s->count; i++)
        s->triangle[i] = (float)(floor(s->triangle[i] * 1000.0 + 0.5) / 1000);
}

/* FNV-1a of what follows the first line, which names the version. */
static uint64_t hash_of(const print *p) {
    uint64_t hash = 14695981039346656037u;
    for (const char *c = strchr(p->text, '\n'); c < p->text + p->size; c++)
        hash = (hash ^ (unsigned char)*c) * 1099511628211u;
    return hash;
}

/* The line of a job: name, hash, bytes. */
static void line_of(char line[128], const golden_job *job, int32_t threads) {
    const char *path = print_path("model.stl");
    shape s = {0};
    print p;
    job->make(&s);
    round_corners(&s);
    CHECK(shape_write_binary(&s, path));
    print_files(&p, &path, 1, job->settings, threads);
    line[0] = 0;
    if (threads == 1)
        print_check(&p, &s);
    if (CHECK_EQUAL(ISO_OK, p.status))
        snprintf(line, 128, "%s %016llx %zu\n", job->name, (unsigned long long)hash_of(&p), p.size);
    print_free(&p);
    shape_free(&s);
}

static int find_line(char line[128], const char *name) {
    FILE *file = fopen(GOLDEN_TABLE, "r");
    int found = 0;
    size_t length = strlen(name);
    while (file && !found && fgets(line, 128, file))
        found = strncmp(line, name, length) == 0 && line[length] == ' ';
    if (file)
        fclose(file);
    return found;
}

static void test_golden(void) {
    static const int32_t threads[] = {1, 2, 4, 8};
    for (int i = 0; i < JOBS; i++)
        for (int t = 0; t < 4; t++) {
            char is[128], was[128] = "nothing\n";
            line_of(is, &jobs[i], threads[t]);
            if (CHECK(find_line(was, jobs[i].name) && strcmp(is, was) == 0))
                continue;
            fprintf(stderr,
                    "    The G-code of %s with %d threads is not what it was:\n"
                    "        is   %s        was  %s"
                    "    If that is meant, renew the table by\n"
                    "        ISO_GOLDEN_WRITE=1 test-golden\n"
                    "    and say in the commit what has changed and why.\n",
                    jobs[i].name, threads[t], is, was);
        }
}

static void write_table(void) {
    FILE *file = fopen(GOLDEN_TABLE, "w");
    for (int i = 0; CHECK(file != NULL) && i < JOBS; i++) {
        char line[128];
        line_of(line, &jobs[i], 1);
        CHECK(fputs(line, file) >= 0);
    }
    CHECK(file && fclose(file) == 0);
    printf("%s is renewed\n", GOLDEN_TABLE);
}

int main(void) {
    if (getenv("ISO_GOLDEN_WRITE"))
        write_table();
    else
        RUN(test_golden);
    CHECK(print_folder_remove());
    return check_verdict();
}
