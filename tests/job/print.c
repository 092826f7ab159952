#include "print.h"

#include <unistd.h>

static char folder[64];
enum { NAMES = 64 };
static char named[NAMES][128];
static int named_count;

const char *print_path(const char *name) {
    char path[128];
    if (!folder[0]) {
        strcpy(folder, "/tmp/isoslice-test-XXXXXX");
        if (!mkdtemp(folder))
            abort();
    }
    snprintf(path, sizeof path, "%s/%s", folder, name);
    for (int i = 0; i < named_count; i++)
        if (strcmp(named[i], path) == 0)
            return named[i];
    if (named_count == NAMES)
        abort();
    return strcpy(named[named_count++], path);
}

int print_folder_remove(void) {
    for (int i = 0; i < named_count; i++)
        remove(named[i]);
    int empty = !folder[0] || rmdir(folder) == 0;
    folder[0] = 0;
    named_count = 0;
    return empty;
}

int print_options(iso_options *options, const char *settings) {
    char key[64];
    static char value[4096];
    iso_options_defaults(options);
    for (const char *line = settings; line && *line;) {
        size_t length = strcspn(line, "\n");
        const char *equal = memchr(line, '=', length);
        if (!equal)
            return 0;
        snprintf(key, sizeof key, "%.*s", (int)strcspn(line, " ="), line);
        const char *from = equal + 1 + strspn(equal + 1, " ");
        snprintf(value, sizeof value, "%.*s", (int)(line + length - from), from);
        if (iso_options_set(options, key, value, "test") != ISO_OK)
            return 0;
        line += length + (line[length] == '\n');
    }
    return 1;
}

/* ---- reading ---- */

static char *read_file(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    if (!file)
        return NULL;
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    char *text = calloc(*size + 1, 1);
    if (fread(text, 1, *size, file) != *size)
        *size = 0;
    fclose(file);
    return text;
}

typedef struct reader {
    print *p;
    double x, y, z, e, f, width, fan;
    int role, tool, unbroken;
    int32_t run;
} reader;

static int word(double *value, const char *line, const char *end, char letter) {
    for (const char *c = line; c < end && *c != ';'; c++)
        if (*c == letter) {
            *value = strtod(c + 1, NULL);
            return 1;
        }
    return 0;
}

static void read_move(reader *r, const char *line, const char *end) {
    print *p = r->p;
    if (p->move_count == p->move_room) {
        p->move_room = p->move_room ? 2 * p->move_room : 1024;
        p->move = realloc(p->move, (size_t)p->move_room * sizeof *p->move);
    }
    print_move *m = &p->move[p->move_count++];
    *m = (print_move){.ax = r->x, .ay = r->y, .az = r->z, .width = r->width, .fan = r->fan};
    double e = 0;
    word(&r->x, line, end, 'X');
    word(&r->y, line, end, 'Y');
    word(&r->z, line, end, 'Z');
    word(&r->f, line, end, 'F');
    int extrudes = word(&e, line, end, 'E');
    if (extrudes) {
        m->e = p->relative ? e : e - r->e;
        r->e = p->relative ? r->e + e : e;
    }
    m->bx = r->x, m->by = r->y, m->bz = r->z, m->f = r->f;
    int level_move = m->bx != m->ax || m->by != m->ay;
    /* what is too little for a last digit of E is drawn all the same */
    int speck =
        level_move && move_length(m) < 0.01 && m->f != floor(60 * p->options.travel_speed + 0.5);
    m->kind = level_move && m->e >= 0 && (extrudes || speck) ? MOVE_DRAW
              : level_move                                   ? MOVE_TRAVEL
              : m->bz != m->az                               ? MOVE_RISE
                                                             : MOVE_FILAMENT;
    m->layer = p->level_count - 1;
    m->role = r->role;
    m->tool = r->tool;
    if (m->kind == MOVE_DRAW && !r->unbroken)
        r->run++;
    r->unbroken = m->kind == MOVE_DRAW;
    m->run = r->run;
}

static void read_comment(reader *r, const char *line, size_t length) {
    print *p = r->p;
    char name[64] = "";
    if (!strncmp(line, ";TYPE:", 6)) {
        snprintf(name, sizeof name, "%.*s", (int)length - 6, line + 6);
        r->role = -1;
        r->unbroken = 0;
        for (int i = 0; i < ISO_ROLE_COUNT; i++)
            if (!strcmp(name, iso_role_name((iso_role)i)))
                r->role = i;
    } else if (!strncmp(line, ";WIDTH:", 7)) {
        r->width = strtod(line + 7, NULL);
    } else if (!strncmp(line, ";LAYER_CHANGE", 13)) {
        if (p->level_count + 1 >= p->level_room) {
            p->level_room = 2 * p->level_room + 64;
            p->level = realloc(p->level, (size_t)p->level_room * sizeof *p->level);
        }
        p->level[p->level_count++] = (print_level){.first = p->move_count};
        r->unbroken = 0;
    } else if (!strncmp(line, ";Z:", 3) && p->level_count > 0) {
        p->level[p->level_count - 1].z = strtod(line + 3, NULL);
    } else if (!strncmp(line, ";HEIGHT:", 8) && p->level_count > 0 &&
               p->level[p->level_count - 1].height == 0) { /* further ones are of single beads */
        p->level[p->level_count - 1].height = strtod(line + 8, NULL);
    }
}

static void read_gcode(print *p) {
    reader r = {.p = p, .role = -1, .run = -1, .x = -1e3, .y = -1e3, .z = -1e3};
    p->level = calloc(2, sizeof *p->level);
    p->level_room = 2;
    for (const char *line = p->text, *end; (end = strchr(line, '\n')); line = end + 1) {
        if (!strncmp(line, "G1 ", 3))
            read_move(&r, line, end);
        else if (!strncmp(line, "G92 E0", 6))
            r.e = 0;
        else if (line[0] == 'T' && (line[1] == '0' || line[1] == '1') &&
                 (line + 2 == end || line[2] == ' '))
            r.tool = line[1] - '0';
        else if (!strncmp(line, "M83", 3) || !strncmp(line, "M82", 3))
            p->relative = line[2] == '3';
        else if (!strncmp(line, "M107", 4))
            r.fan = 0;
        else if (!strncmp(line, "M106 S", 6))
            r.fan = strtod(line + 6, NULL) * 100 / 255;
        else if (*line == ';')
            read_comment(&r, line, (size_t)(end - line));
    }
    p->level[p->level_count].first = p->move_count;
}

/* ---- printing ---- */

/* The firmware that the options describe. */
static void set_machine(fio_virtual_options *machine, const iso_options *options) {
    machine->print_acceleration = options->machine_max_acceleration_extruding;
    machine->travel_acceleration = options->machine_max_acceleration_travel;
    machine->retract_acceleration = options->machine_max_acceleration_retracting;
    machine->junction_deviation = options->machine_max_junction_deviation;
    const iso_options *o = options;
    const double limits[4][3] = {
        {o->machine_max_feedrate_x, o->machine_max_acceleration_x, o->machine_max_jerk_x},
        {o->machine_max_feedrate_y, o->machine_max_acceleration_y, o->machine_max_jerk_y},
        {o->machine_max_feedrate_z, o->machine_max_acceleration_z, o->machine_max_jerk_z},
        {o->machine_max_feedrate_e, o->machine_max_acceleration_e, o->machine_max_jerk_e}};
    for (int i = 0; i < 4; i++) {
        machine->maximum_feedrate[i] = limits[i][0];
        machine->maximum_acceleration[i] = limits[i][1];
        machine->jerk[i] = limits[i][2];
    }
    machine->classic_jerk = o->gcode_flavor == ISO_FLAVOUR_MARLIN;
    machine->filament_diameter = options->filament_diameter;
    machine->maximum_flow = 1000;
    machine->tools = *options->lattice_material ? 2 : 1;
}

static void set_volume(fio_virtual_options *machine, const iso_options *options) {
    const iso_points *bed = &options->bed_shape;
    double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
    for (int32_t i = 0; i < bed->count; i++) {
        low[0] = fmin(low[0], bed->point[i].x), high[0] = fmax(high[0], bed->point[i].x);
        low[1] = fmin(low[1], bed->point[i].y), high[1] = fmax(high[1], bed->point[i].y);
    }
    for (int k = 0; k < 2; k++) {
        machine->origin[k] = low[k];
        machine->size[k] = high[k] - low[k];
    }
    machine->origin[2] = fmin(0, options->z_offset);
    machine->size[2] = options->max_print_height + options->retract_lift + fabs(options->z_offset);
}

static void run_printer(print *p) {
    fio_virtual_options machine = fio_virtual_options_defaults();
    fio_virtual_printer *printer;
    set_machine(&machine, &p->options);
    set_volume(&machine, &p->options);
    p->verdict = fio_virtual_printer_create(&printer, &machine, NULL);
    if (p->verdict != FIO_OK)
        return;
    p->verdict = fio_virtual_printer_run(printer, p->text, p->size);
    if (p->verdict == FIO_OK)
        p->verdict = fio_virtual_printer_finish(printer);
    fio_virtual_printer_state(printer, &p->state);
    p->machine = *fio_virtual_printer_statistics(printer);
    const fio_event *event = fio_virtual_printer_fault(printer, 0);
    if (!event)
        event = fio_virtual_printer_warning(printer, 0);
    if (event)
        snprintf(p->complaint, sizeof p->complaint, "%s, line %lld: %s",
                 fio_event_name(event->code), (long long)event->line, event->text);
    fio_virtual_printer_free(printer);
}

void print_files(print *p, const char *const *path, int32_t count, const char *settings,
                 int32_t threads) {
    iso_job_hooks hooks = {.threads = threads};
    const char *output = print_path("out.gcode");
    memset(p, 0, sizeof *p);
    if (!print_options(&p->options, settings)) {
        p->status = ISO_BAD_CONFIG;
        snprintf(p->message, sizeof p->message, "%s", iso_error_message());
        return;
    }
    remove(output);
    p->status = iso_job_run(&p->report, &p->options, path, count, output, &hooks);
    if (p->status != ISO_OK)
        snprintf(p->message, sizeof p->message, "%s", iso_error_message());
    p->text = read_file(output, &p->size);
    if (p->status != ISO_OK || !p->text)
        return;
    read_gcode(p);
    run_printer(p);
}

void print_shape(print *p, const shape *s, const char *settings) {
    const char *path = print_path("model.stl");
    shape_write_binary(s, path);
    print_files(p, &path, 1, settings, 1);
}

void print_free(print *p) {
    iso_report_free(&p->report);
    free(p->text);
    free(p->move);
    free(p->level);
    p->text = NULL, p->move = NULL, p->level = NULL;
    p->move_count = p->level_count = 0;
}

/* ---- sums ---- */

double move_length(const print_move *m) {
    return sqrt((m->bx - m->ax) * (m->bx - m->ax) + (m->by - m->ay) * (m->by - m->ay));
}

int move_chosen(const print_move *m, int role, int32_t layer) {
    return m->kind == MOVE_DRAW && (layer < 0 || m->layer == layer) &&
           (role < 0 ? m->role != ISO_ROLE_SKIRT : m->role == role);
}

double print_length(const print *p, int role, int32_t layer) {
    double sum = 0;
    for (int32_t i = 0; i < p->move_count; i++)
        sum += move_chosen(&p->move[i], role, layer) ? move_length(&p->move[i]) : 0;
    return sum;
}

double print_filament(const print *p, int role, int32_t layer) {
    double sum = 0;
    for (int32_t i = 0; i < p->move_count; i++)
        sum += move_chosen(&p->move[i], role, layer) ? p->move[i].e : 0;
    return sum;
}

int32_t print_runs(const print *p, int role, int32_t layer) {
    int32_t runs = 0, last = -1;
    for (int32_t i = 0; i < p->move_count; i++)
        if (move_chosen(&p->move[i], role, layer) && p->move[i].run != last) {
            last = p->move[i].run;
            runs++;
        }
    return runs;
}

int print_box(double box[4], const print *p, int role, int32_t layer) {
    box[0] = box[1] = 1e9;
    box[2] = box[3] = -1e9;
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (!move_chosen(m, role, layer))
            continue;
        box[0] = fmin(box[0], fmin(m->ax, m->bx)), box[2] = fmax(box[2], fmax(m->ax, m->bx));
        box[1] = fmin(box[1], fmin(m->ay, m->by)), box[3] = fmax(box[3], fmax(m->ay, m->by));
    }
    return box[0] <= box[2];
}

double print_volume(const print *p) {
    double d = p->options.filament_diameter;
    return print_filament(p, -1, -1) * SHAPE_PI / 4 * d * d / p->options.extrusion_multiplier;
}

/* ---- the model ---- */

shape_box3 shape_bounds(const shape *s) {
    shape_box3 b;
    for (int k = 0; k < 3; k++)
        b.min[k] = 1e9, b.max[k] = -1e9;
    for (int64_t i = 0; i < 3 * s->count; i++)
        for (int k = 0; k < 3; k++) {
            b.min[k] = fmin(b.min[k], (double)s->triangle[3 * i + k]);
            b.max[k] = fmax(b.max[k], (double)s->triangle[3 * i + k]);
        }
    return b;
}

static void cut_edge(double at[2], const float *a, const float *b, double z) {
    double t = (z - a[2]) / ((double)b[2] - a[2]);
    at[0] = a[0] + t * ((double)b[0] - a[0]);
    at[1] = a[1] + t * ((double)b[1] - a[1]);
}

/* Material lies on the left of each piece. */
static int cut_triangle(double piece[4], const float *v, double z) {
    int cut = 0;
    for (int k = 0; k < 3; k++) {
        const float *a = v + 3 * k, *b = v + 3 * ((k + 1) % 3);
        int up = a[2] <= z && b[2] > z, down = a[2] > z && b[2] <= z;
        if (up)
            cut_edge(piece + 2, a, b, z);
        if (down)
            cut_edge(piece, a, b, z);
        cut += up || down;
    }
    return cut == 2;
}

int64_t shape_section(double (*piece)[4], const shape *s, double z) {
    int64_t count = 0;
    for (int64_t t = 0; t < s->count; t++)
        count += cut_triangle(piece[count], s->triangle + 9 * t, z);
    return count;
}

int section_winding(const double (*piece)[4], int64_t count, double x, double y) {
    int winding = 0;
    for (int64_t i = 0; i < count; i++) {
        const double *p = piece[i];
        int up = p[1] <= y && p[3] > y, down = p[1] > y && p[3] <= y;
        double side = (p[2] - p[0]) * (y - p[1]) - (p[3] - p[1]) * (x - p[0]);
        winding += (up && side > 0) - (down && side < 0);
    }
    return winding;
}

double section_distance(const double (*piece)[4], int64_t count, double x, double y) {
    double least = 1e9;
    for (int64_t i = 0; i < count; i++) {
        const double *p = piece[i];
        double ux = p[2] - p[0], uy = p[3] - p[1], vx = x - p[0], vy = y - p[1];
        double squared = ux * ux + uy * uy;
        double t = squared > 0 ? fmin(1, fmax(0, (ux * vx + uy * vy) / squared)) : 0;
        least = fmin(least, hypot(vx - t * ux, vy - t * uy));
    }
    return least;
}

double shape_area_at(const shape *s, double z) {
    double sum = 0, ox = s->triangle[0], oy = s->triangle[1];
    for (int64_t t = 0; t < s->count; t++) {
        double p[4];
        if (cut_triangle(p, s->triangle + 9 * t, z))
            sum += (p[0] - ox) * (p[3] - oy) - (p[2] - ox) * (p[1] - oy);
    }
    return sum / 2;
}

double shape_volume(const shape *s) {
    double sum = 0;
    for (int64_t t = 0; t < s->count; t++) {
        const float *v = s->triangle + 9 * t;
        double a[3] = {v[0], v[1], v[2]}, b[3] = {v[3], v[4], v[5]}, c[3] = {v[6], v[7], v[8]};
        sum += a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return sum / 6;
}

double shape_layered_volume(const shape *s, const print *p) {
    double bottom = shape_bounds(s).min[2], top = 0, sum = 0;
    for (int32_t i = 0; i < p->level_count; i++) {
        double height = p->level[i].height;
        sum += shape_area_at(s, bottom + top + height / 2) * height;
        top += height;
    }
    return sum;
}

double shape_surface(const shape *s) {
    double sum = 0;
    for (int64_t t = 0; t < s->count; t++) {
        const float *v = s->triangle + 9 * t;
        double u[3], w[3];
        for (int k = 0; k < 3; k++)
            u[k] = (double)v[3 + k] - v[k], w[k] = (double)v[6 + k] - v[k];
        double x = u[1] * w[2] - u[2] * w[1], y = u[2] * w[0] - u[0] * w[2];
        double z = u[0] * w[1] - u[1] * w[0];
        sum += sqrt(x * x + y * y + z * z);
    }
    return sum / 2;
}
