#include "clearance/room.h"

#include "base/memory.h"
#include "clearance/beads.h"

/* A tile has 8 x 8 x 8 cells; the tree's root has 1024 x 1024 x 1024 tiles: more than
 * ISO_COORDINATE_MAX allows. */
#define CELL 0.7 /* mm */
enum { TILE = 8, LEVELS = 10 };
#define ORIGIN (-CELL * TILE * (1 << LEVELS) / 2)
#define HALF_DIAGONAL 0.8660254037844387 /* of a cube of side 1, rounded up */
#define ROUND 1e-3                       /* mm, more than what single precision is off */

typedef struct room_cell {
    float offset;      /* of the plane, times 32767 mm, from the cell's middle */
    int16_t normal[3]; /* in 32767ths; all 0: the cell is empty */
} room_cell;

/* Cells in Morton order: cubes of 4 x 4 x 4 cells, in each those of 2 x 2 x 2, in each cells. */
typedef struct room_tile {
    uint64_t used; /* cubes of 2 x 2 x 2 with anything in them */
    room_cell cell[TILE * TILE * TILE];
} room_tile;

typedef struct room_node {
    int32_t child[8]; /* 0: empty; of the last level a tile, else a node */
} room_node;

struct room_map {
    const tool_body *tool;
    tool_shape shape[TOOL_PARTS]; /* shrunk; the nozzle not raised */
    bool there[TOOL_PARTS];
    double boxes_from; /* the least height of all but the nozzle */
    double cosine;
    int32_t node_count, tile_count;
    int64_t node_capacity, tile_capacity;
    room_node *node;            /* 0 is the root */
    room_tile **tile;           /* 0 is none */
    int32_t last[3], last_tile; /* the one asked for last */
};

#define BOX_MARGIN 0.02 /* mm: what pieces of long beads may be off */
#define FAR 1e5         /* mm, beyond all there is */

iso_status room_new(room_map **made, const tool_body *tool) {
    room_map *room;
    ISO_TRY(ISO_ALLOCATE(room, 1));
    memset(room, 0, sizeof *room);
    room->tool = tool;
    room->cosine = 1 / tool->secant;
    room->boxes_from = INFINITY;
    for (int i = 0; i < TOOL_PARTS; i++) {
        room->there[i] = tool_shape_of(&room->shape[i], tool, (tool_part)i,
                                       (double[]){0, CLEARANCE_TOLERANCE}, FAR);
        if (i != TOOL_NOZZLE && room->there[i])
            room->boxes_from = least_of(room->boxes_from, room->shape[i].low);
    }
    iso_status status = ISO_GROW(room->node, room->node_capacity, 64);
    if (status == ISO_OK)
        status = ISO_GROW(room->tile, room->tile_capacity, 64);
    if (status != ISO_OK) {
        room_free(room);
        return status;
    }
    room->node[0] = (room_node){{0}};
    room->tile[0] = NULL;
    room->node_count = room->tile_count = 1;
    *made = room;
    return ISO_OK;
}

void room_free(room_map *room) {
    if (!room)
        return;
    for (int32_t i = 1; i < room->tile_count; i++)
        iso_release(room->tile[i]);
    iso_release(room->tile);
    iso_release(room->node);
    iso_release(room);
}

int64_t room_bytes(const room_map *room) {
    return (int64_t)sizeof *room + room->node_capacity * (int64_t)sizeof(room_node) +
           room->tile_capacity * (int64_t)sizeof(room_tile *) +
           room->tile_count * (int64_t)sizeof(room_tile);
}

/* ---- beads come in ---- */

/* The bit of each coordinate that says in which of eight cubes it is. */
static int octant(const int32_t at[3], int bit) {
    return (at[0] >> bit & 1) | (at[1] >> bit & 1) << 1 | (at[2] >> bit & 1) << 2;
}

static iso_status new_tile(int32_t *made, room_map *room) {
    ISO_TRY(ISO_GROW(room->tile, room->tile_capacity, room->tile_count + 1));
    room_tile *tile;
    ISO_TRY(ISO_ALLOCATE(tile, 1));
    memset(tile, 0, sizeof *tile);
    *made = room->tile_count;
    room->tile[room->tile_count++] = tile;
    return ISO_OK;
}

static iso_status tile_at(room_tile **found, room_map *room, const int32_t at[3]) {
    if (!room->last_tile || memcmp(at, room->last, sizeof room->last) != 0) {
        int32_t node = 0;
        for (int bit = LEVELS - 1; bit >= 0; bit--) {
            int way = octant(at, bit);
            int32_t next = room->node[node].child[way];
            if (!next && bit == 0) {
                ISO_TRY(new_tile(&next, room));
            } else if (!next) {
                ISO_TRY(ISO_GROW(room->node, room->node_capacity, room->node_count + 1));
                next = room->node_count++;
                room->node[next] = (room_node){{0}};
            }
            room->node[node].child[way] = next;
            node = next;
        }
        memcpy(room->last, at, sizeof room->last);
        room->last_tile = node;
    }
    *found = room->tile[room->last_tile];
    return ISO_OK;
}

/* A bead by its two ends: discs with a ball rolled around them. */
typedef struct room_print {
    iso_vec3 center[2], normal[2];
    double disc, ball;
    int16_t across[3]; /* square to it */
    double offset;     /* of the plane with that normal */
} room_print;

static iso_vec3 parts_of(const int16_t normal[3]) {
    return vec3(normal[0], normal[1], normal[2]);
}

/* How far the bead goes in a direction, times its length. */
static double extent(const room_print *print, iso_vec3 way) {
    double most = -INFINITY, square = vec3_dot(way, way);
    for (int end = 0; end < 2; end++) {
        double along = vec3_dot(way, print->normal[end]);
        most = most_of(most, vec3_dot(way, print->center[end]) +
                                 print->disc * sqrt(most_of(0, square - along * along)));
    }
    return most + print->ball * sqrt(square);
}

static room_print print_of(const clearance_move *bead) {
    double across = least_of(bead->width, bead->height);
    room_print print = {.normal = {bead->from_normal, bead->to_normal},
                        .disc = (bead->width - across) / 2,
                        .ball = across / 2};
    print.center[0] = vec3_along(bead->from, -print.ball, bead->from_normal);
    print.center[1] = vec3_along(bead->to, -print.ball, bead->to_normal);
    iso_vec3 normal = vec3_unit(vec3_plus(bead->from_normal, bead->to_normal));
    if (!(vec3_dot(normal, normal) > 0.5))
        normal = bead->from_normal;
    print.across[0] = (int16_t)(normal.x * 32767);
    print.across[1] = (int16_t)(normal.y * 32767);
    print.across[2] = (int16_t)(normal.z * 32767);
    print.offset = extent(&print, parts_of(print.across)) + 32767 * ROUND;
    return print;
}

static void enter(room_cell *cell, const room_print *print, iso_vec3 middle) {
    iso_vec3 across = parts_of(print->across), old = parts_of(cell->normal);
    double offset = print->offset - vec3_dot(across, middle);
    if (memcmp(cell->normal, print->across, sizeof cell->normal) == 0) {
        cell->offset = (float)most_of(offset, cell->offset);
        return;
    }
    if (cell->normal[0] || cell->normal[1] || cell->normal[2]) {
        /* Either normal will do: the one of the lower plane. */
        iso_vec3 change = vec3_minus(across, old);
        double turned = cell->offset + 32767 * ROUND +
                        (fabs(change.x) + fabs(change.y) + fabs(change.z)) * (CELL / 2);
        double kept = extent(print, old) - vec3_dot(old, middle) + 32767 * ROUND;
        offset = most_of(offset, turned);
        kept = most_of(kept, cell->offset);
        if (kept <= offset) {
            cell->offset = (float)kept;
            return;
        }
    }
    cell->offset = (float)offset;
    memcpy(cell->normal, print->across, sizeof cell->normal);
}

/* The square of the distance from a place to the line between the discs. */
static double distance_to(const room_print *print, iso_vec3 at) {
    iso_vec3 way = vec3_minus(print->center[1], print->center[0]);
    iso_vec3 from = vec3_minus(at, print->center[0]);
    double length = vec3_dot(way, way), along = vec3_dot(from, way);
    double t = along <= 0 ? 0 : along >= length ? 1 : along / length;
    iso_vec3 rest = vec3_along(from, -t, way);
    return vec3_dot(rest, rest);
}

static int32_t cell_at(double mm) {
    double at = (mm - ORIGIN) / CELL, most = TILE * (1 << LEVELS) - 1;
    return (int32_t)(at < 0 ? 0 : at > most ? most : at);
}

static iso_status enter_cell(room_map *room, const room_print *print, const int32_t at[3]) {
    iso_vec3 middle = vec3(ORIGIN + CELL * (at[0] + 0.5), ORIGIN + CELL * (at[1] + 0.5),
                           ORIGIN + CELL * (at[2] + 0.5));
    double most = print->disc + print->ball + CELL * HALF_DIAGONAL;
    if (distance_to(print, middle) > most * most)
        return ISO_OK;
    room_tile *tile;
    ISO_TRY(tile_at(&tile, room, (int32_t[]){at[0] / TILE, at[1] / TILE, at[2] / TILE}));
    int cube = octant(at, 2) << 3 | octant(at, 1);
    tile->used |= (uint64_t)1 << cube;
    enter(&tile->cell[cube << 3 | octant(at, 0)], print, middle);
    return ISO_OK;
}

/* Long beads are taken piece by piece, so that their boxes hold few cells. */
static iso_status enter_piece(room_map *room, const room_print *print,
                              const clearance_move *piece) {
    double low[3], high[3];
    beads_box(low, high, piece);
    int32_t at[3], last[3];
    for (int k = 0; k < 3; k++)
        last[k] = cell_at(high[k] + BOX_MARGIN);
    for (at[2] = cell_at(low[2] - BOX_MARGIN); at[2] <= last[2]; at[2]++)
        for (at[1] = cell_at(low[1] - BOX_MARGIN); at[1] <= last[1]; at[1]++)
            for (at[0] = cell_at(low[0] - BOX_MARGIN); at[0] <= last[0]; at[0]++)
                ISO_TRY(enter_cell(room, print, at));
    return ISO_OK;
}

/* The bead from `t` on to `t + part`: its discs are between those at the ends, not turned evenly,
 * so that they are made a little larger. */
static room_print piece_of(const clearance_move *bead, const clearance_move *piece, double t,
                           double part) {
    room_print print = print_of(piece), whole = print_of(bead);
    iso_vec3 turn = vec3_minus(bead->to_normal, bead->from_normal);
    print.disc *= 1 + vec3_dot(turn, turn);
    print.center[0] = vec3_between(whole.center[0], whole.center[1], t);
    print.center[1] = vec3_between(whole.center[0], whole.center[1], t + part);
    print.offset = extent(&print, parts_of(print.across)) + 32767 * ROUND;
    return print;
}

iso_status room_add(room_map *room, const clearance_move *bead) {
    enum { PIECE = 3 }; /* mm */
    int count = 1 + (int)(vec3_distance(bead->from, bead->to) / PIECE);
    if (count == 1) {
        room_print print = print_of(bead);
        return enter_piece(room, &print, bead);
    }
    clearance_move piece = *bead;
    for (int i = 0; i < count; i++) {
        double t = (double)i / count, end = (i + 1.0) / count;
        piece.from = vec3_between(bead->from, bead->to, t);
        piece.to = vec3_between(bead->from, bead->to, end);
        piece.from_normal = vec3_unit(vec3_between(bead->from_normal, bead->to_normal, t));
        piece.to_normal = vec3_unit(vec3_between(bead->from_normal, bead->to_normal, end));
        room_print print = piece_of(bead, &piece, t, end - t);
        ISO_TRY(enter_piece(room, &print, &piece));
    }
    return ISO_OK;
}

/* ---- questions ---- */

typedef struct room_question {
    const room_map *room;
    const tool_pose *pose;
    ground_doubt *doubt;
    tool_shape nozzle;        /* raised */
    double lowest;            /* height of anything of the tool */
    iso_vec3 tip, x, y, axis; /* halfway */
    double way, rise, turn;   /* half of how far the tip goes, of that along the axis, and of how
                               * much the tool turns */
} room_question;

/* Parts that a ball may meet, anywhere on the way: for each, halfspaces that the part lies in. */
static int parts_near(const room_question *question, iso_vec3 middle, double ball) {
    const room_map *room = question->room;
    iso_vec3 from = vec3_minus(middle, question->tip);
    double square = vec3_dot(from, from), height = vec3_dot(from, question->axis);
    double turned = question->turn > 0 ? question->turn * (sqrt(square) + ball) : 0;
    double around = ball + question->way + turned, tall = ball + question->rise + turned;
    if (height + tall < question->lowest)
        return 0;
    int parts = 0;
    if (room->there[TOOL_NOZZLE] && height - tall < question->nozzle.high) {
        const tool_shape *cone = &question->nozzle;
        double radius = sqrt(most_of(0, square - height * height));
        double side = radius - cone->radius_low - (height - cone->low) * room->tool->tangent;
        if (side * room->cosine < around)
            parts |= 1 << TOOL_NOZZLE;
    }
    if (height + tall < room->boxes_from)
        return parts;
    double x = vec3_dot(from, question->x), y = vec3_dot(from, question->y);
    for (int i = TOOL_BLOCK; i < TOOL_PARTS; i++) {
        const tool_shape *shape = &room->shape[i];
        if (!room->there[i] || height + tall < shape->low)
            continue;
        if (shape->round ? square - height * height >
                               (shape->radius_low + around) * (shape->radius_low + around)
                         : x + around < shape->box_low.x || x - around > shape->box_high.x ||
                               y + around < shape->box_low.y || y - around > shape->box_high.y)
            continue;
        parts |= 1 << i;
    }
    return parts;
}

/* Of places no more than `far` from the tip, between the poses they are off the line between those
 * by no more than this. */
static double sag_of(const room_question *question, double far) {
    return far * question->turn * question->turn / 2;
}

/* Is a box above the cell's plane in both poses, and between? */
static bool box_above(const room_question *question, const tool_shape *shape, const room_cell *cell,
                      iso_vec3 middle) {
    iso_vec3 up = parts_of(cell->normal), down = vec3_times(up, -1);
    double far = shape->round ? shape->radius_low
                              : fabs(shape->box_low.x) + fabs(shape->box_high.x) +
                                    fabs(shape->box_low.y) + fabs(shape->box_high.y);
    double sag = 32767 * sag_of(question, far + shape->low);
    for (int end = 0; end < 2; end++) {
        const tool_pose *pose = &question->pose[end];
        if (vec3_dot(up, pose->axis) <= 0)
            return false;
        iso_vec3 lowest = vec3_minus(tool_support(shape, pose, down), middle);
        if (vec3_dot(up, lowest) - sag <= cell->offset)
            return false;
    }
    return true;
}

/* The same of the nozzle: of its flats at both ends. */
static bool nozzle_above(const room_question *question, const room_cell *cell, iso_vec3 middle) {
    const tool_shape *cone = &question->nozzle;
    iso_vec3 up = parts_of(cell->normal);
    double size = vec3_dot(up, up);
    double low_sag = 32767 * sag_of(question, cone->low + cone->radius_low);
    double high_sag = 32767 * sag_of(question, cone->high + cone->radius_high);
    for (int end = 0; end < 2; end++) {
        const tool_pose *pose = &question->pose[end];
        double along = vec3_dot(up, pose->axis), tip = vec3_dot(up, vec3_minus(pose->tip, middle));
        double across = sqrt(most_of(0, size - along * along));
        double low = tip + cone->low * along - cone->radius_low * across - low_sag;
        double high = tip + cone->high * along - cone->radius_high * across - high_sag;
        if (low <= cell->offset || high <= cell->offset)
            return false;
    }
    return true;
}

/* Is all that is in the cell, under its plane, beyond the plane that touches the cone where it
 * faces the cell? With w square to that plane and m to the cell's, w p = (w + a m) p - a m p is at
 * least what the first is in the cell's corners, less a times the cell's offset, for any a > 0. */
static bool cone_beside(const room_question *question, const room_cell *cell, iso_vec3 middle) {
    const tool_shape *cone = &question->nozzle;
    double cosine = question->room->cosine, sine = cosine * question->room->tool->tangent;
    iso_vec3 from = vec3_minus(middle, question->tip);
    iso_vec3 out = vec3_along(from, -vec3_dot(from, question->axis), question->axis);
    iso_vec3 side = vec3_along(vec3_times(vec3_unit(out), cosine), -sine, question->axis);
    iso_vec3 rest = vec3_along(side, sine / 32767, parts_of(cell->normal));
    double corner = (fabs(rest.x) + fabs(rest.y) + fabs(rest.z)) * (CELL / 2);
    double least = -corner - sine * cell->offset / 32767;
    least -= sag_of(question, cone->high + cone->radius_high);
    for (int end = 0; end < 2; end++) {
        iso_vec3 most = tool_support(cone, &question->pose[end], side);
        if (vec3_dot(side, vec3_minus(most, middle)) >= least)
            return false;
    }
    return true;
}

static void ask_cell(room_question *question, const room_cell *cell, iso_vec3 middle) {
    int near = parts_near(question, middle, CELL * HALF_DIAGONAL), parts = 0;
    for (int i = 0; near >> i; i++)
        if ((near >> i & 1) &&
            !(i == TOOL_NOZZLE
                  ? nozzle_above(question, cell, middle) || cone_beside(question, cell, middle)
                  : box_above(question, &question->room->shape[i], cell, middle)))
            parts |= 1 << i;
    if (!parts)
        return;
    double side = CELL / 2;
    const ground_doubt more = {parts,
                               {middle.x - side, middle.y - side, middle.z - side},
                               {middle.x + side, middle.y + side, middle.z + side}};
    ground_doubt_add(question->doubt, &more);
}

/* The middle of one of eight cubes of a side. */
static iso_vec3 middle_of(iso_vec3 middle, int octant, double side) {
    return vec3(middle.x + (octant & 1 ? side : -side) / 2,
                middle.y + (octant & 2 ? side : -side) / 2,
                middle.z + (octant & 4 ? side : -side) / 2);
}

static void ask_tile(room_question *question, const room_tile *tile, iso_vec3 middle) {
    for (int i = 0; i < 8; i++) {
        int used = (int)(tile->used >> (8 * i) & 255);
        iso_vec3 large = middle_of(middle, i, 4 * CELL);
        if (!used || !parts_near(question, large, 4 * CELL * HALF_DIAGONAL))
            continue;
        for (int k = 0; k < 8; k++) {
            iso_vec3 small = middle_of(large, k, 2 * CELL);
            if (!(used >> k & 1) || !parts_near(question, small, 2 * CELL * HALF_DIAGONAL))
                continue;
            const room_cell *cell = tile->cell + (i << 6 | k << 3);
            for (int l = 0; l < 8; l++, cell++)
                if (cell->normal[0] || cell->normal[1] || cell->normal[2])
                    ask_cell(question, cell, middle_of(small, l, CELL));
        }
    }
}

static void ask(room_question *question, int32_t node, int level, iso_vec3 middle) {
    const room_map *room = question->room;
    double side = CELL * TILE * (1 << (level - 1));
    for (int i = 0; i < 8; i++) {
        int32_t child = room->node[node].child[i];
        iso_vec3 there = middle_of(middle, i, side);
        if (!child || !parts_near(question, there, side * HALF_DIAGONAL))
            continue;
        if (level == 1)
            ask_tile(question, room->tile[child], there);
        else
            ask(question, child, level - 1, there);
    }
}

void room_check(ground_doubt *doubt, const room_map *room, const tool_pose pose[2], double raise) {
    room_question question = {.room = room, .pose = pose, .doubt = doubt};
    *doubt = ground_doubt_none();
    question.nozzle = room->shape[TOOL_NOZZLE];
    if (!tool_shape_of(&question.nozzle, room->tool, TOOL_NOZZLE,
                       (double[]){raise, CLEARANCE_TOLERANCE}, FAR))
        question.nozzle.high = question.nozzle.low; /* nothing is left of it, or little */
    question.lowest = least_of(question.nozzle.low, room->boxes_from);
    tool_pose halfway = tool_pose_at(room->tool, vec3_between(pose[0].tip, pose[1].tip, 0.5),
                                     vec3_plus(pose[0].axis, pose[1].axis));
    question.tip = halfway.tip;
    question.x = halfway.x;
    question.y = halfway.y;
    question.axis = halfway.axis;
    question.way = vec3_distance(pose[0].tip, pose[1].tip) / 2;
    question.rise = fabs(vec3_dot(vec3_minus(pose[1].tip, pose[0].tip), halfway.axis)) / 2;
    double turn = vec3_distance(pose[0].axis, pose[1].axis);
    turn = most_of(turn, vec3_distance(pose[0].x, pose[1].x));
    turn = most_of(turn, vec3_distance(pose[0].y, pose[1].y));
    /* Some axis goes by a chord of at least sqrt(2 / 3) of the angle; half of that, and more. */
    question.turn = turn * 0.8;
    iso_vec3 middle = vec3(ORIGIN + CELL * TILE * (1 << LEVELS) / 2, 0, 0);
    middle.y = middle.z = middle.x;
    ask(&question, 0, LEVELS, middle);
}
