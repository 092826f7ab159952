#include "clearance/exact.h"

#include "base/memory.h"
#include "clearance/touch.h"

/* Between the poses it is cut into a turning tool is taken to move straight. What is no more than
 * 200 mm from the tip, or of the nozzle, is off by no more than this then. */
#define TURN_TOLERANCE 0.002 /* mm */
#define TURN_REACH 200.0     /* mm */

/* Slabs are worth their number where much of the nozzle is in doubt. */
#define SLABS_FROM 4.0 /* mm */

enum { SLABS = 4, PARTS_MOST = SLABS + TOOL_PARTS - 1, BATCH = 64 };

typedef struct exact_piece {
    touch_sweep sweep;
    double raise;
    tool_part part;
    int32_t move; /* of the batch */
} exact_piece;

typedef struct exact_search {
    const tool_body *tool;
    bead_store *beads;
    const exact_move *move;
    int64_t piece_count, query_count, capacity;
    exact_piece *piece;
    float *box;  /* [6 query_count] */
    int32_t *of; /* [query_count] piece */
} exact_search;

/* How far beads are from the tip at most; nothing of the tool needs to be longer. */
static double reach_of(const bead_store *beads, const clearance_move *move) {
    double most = 0;
    for (int end = 0; end < 2; end++) {
        iso_vec3 tip = end ? move->to : move->from;
        const double at[3] = {tip.x, tip.y, tip.z};
        double sum = 0;
        for (int k = 0; k < 3; k++) {
            double far = most_of(fabs(beads->low[k] - at[k]), fabs(beads->high[k] - at[k]));
            sum += far * far;
        }
        most = most_of(most, sqrt(sum));
    }
    return most + 1;
}

/* No part of the tool needs to be longer for it to meet the bead. Of the bead alone: the answer
 * must not depend on what else there is. */
static double reach_to(const exact_piece *piece, const clearance_move *bead) {
    double far = 0;
    for (int i = 0; i < 4; i++)
        far = most_of(far,
                      vec3_distance(piece->sweep.pose[i / 2].tip, i % 2 ? bead->to : bead->from));
    return far + bead->width + bead->height + 1;
}

/* Into how many pieces a part of the tool cuts a move that it turns on, all of it. */
static double turns_of(const exact_search *search, const clearance_move *move, tool_part part) {
    const tool_body *tool = search->tool;
    if (tool->model.turning == CLEARANCE_UPRIGHT)
        return 0;
    double reach = TURN_REACH;
    if (part == TOOL_NOZZLE)
        reach = tool->model.tip_diameter / 2 + tool->model.cone_height * tool->secant;
    return vec3_distance(move->from_normal, move->to_normal) / sqrt(8 * TURN_TOLERANCE / reach);
}

/* A question: the box of a sweep, as far as there is doubt. */
static void ask(exact_search *search, const touch_sweep *sweep, int32_t piece) {
    const ground_doubt *doubt = &search->move[search->piece[piece].move].doubt;
    double low[3] = {doubt->low.x, doubt->low.y, doubt->low.z};
    double high[3] = {doubt->high.x, doubt->high.y, doubt->high.z};
    float *box = search->box + 6 * search->query_count;
    for (int k = 0; k < 3; k++) {
        iso_vec3 way = vec3(k == 0, k == 1, k == 2), back = vec3_times(way, -1);
        low[k] = most_of(low[k], vec3_dot(touch_sweep_support(sweep, back), way));
        high[k] = least_of(high[k], vec3_dot(touch_sweep_support(sweep, way), way));
        if (low[k] > high[k])
            return;
        box[k] = (float)low[k] - 0.002f; /* more than all rounding */
        box[3 + k] = (float)high[k] + 0.002f;
    }
    search->of[search->query_count++] = piece;
}

/* A cone in slabs, each twice as high as the one below, whose boxes hold less than one. */
static void enter_slabs(exact_search *search, const touch_sweep *sweep, int32_t piece) {
    touch_sweep slab = *sweep;
    const tool_shape *whole = &sweep->shape;
    double length = whole->high - whole->low;
    double slope = (whole->radius_high - whole->radius_low) / length;
    for (int i = 0; i < SLABS; i++) {
        double from = i ? length / (1 << (SLABS - i)) : 0, to = length / (1 << (SLABS - 1 - i));
        slab.shape.low = whole->low + from;
        slab.shape.high = whole->low + to;
        slab.shape.radius_low = whole->radius_low + slope * from;
        slab.shape.radius_high = whole->radius_low + slope * to;
        ask(search, &slab, piece);
    }
}

static iso_status make_room(exact_search *search) {
    int64_t before = search->capacity, needed = search->query_count + PARTS_MOST;
    if (search->piece_count + TOOL_PARTS > needed)
        needed = search->piece_count + TOOL_PARTS;
    if (needed <= before)
        return ISO_OK;
    int64_t capacity[3] = {before, 6 * before, before};
    needed = needed > 2 * before ? needed : 2 * before;
    ISO_TRY(ISO_GROW(search->piece, capacity[0], needed));
    ISO_TRY(ISO_GROW(search->box, capacity[1], 6 * needed));
    ISO_TRY(ISO_GROW(search->of, capacity[2], needed));
    search->capacity = needed;
    return ISO_OK;
}

/* A part of the tool along a piece of a move. */
static iso_status enter_piece(exact_search *search, const exact_piece *piece, double reach) {
    ISO_TRY(make_room(search));
    int32_t index = (int32_t)search->piece_count;
    exact_piece *entered = search->piece + index;
    *entered = *piece;
    if (!tool_shape_of(&entered->sweep.shape, search->tool, piece->part,
                       (double[]){piece->raise, CLEARANCE_TOLERANCE}, reach))
        return ISO_OK;
    search->piece_count++;
    const ground_doubt *doubt = &search->move[piece->move].doubt;
    if (piece->part == TOOL_NOZZLE && doubt->high.z - doubt->low.z > SLABS_FROM)
        enter_slabs(search, &entered->sweep, index);
    else
        ask(search, &entered->sweep, index);
    return ISO_OK;
}

static iso_status enter_section(exact_search *search, int32_t at, const way_section *section,
                                tool_part part, double reach) {
    const clearance_move *move = &search->move[at].move;
    double length = section->to - section->from;
    int count = 1 + (int)(turns_of(search, move, part) * length);
    exact_piece piece = {.raise = section->raise, .part = part, .move = at};
    tool_pose *pose = piece.sweep.pose;
    for (int k = 0; k <= count; k++) {
        double t = section->from + length * k / count;
        pose[0] = pose[1];
        pose[1] = tool_pose_at(search->tool, vec3_between(move->from, move->to, t),
                               vec3_between(move->from_normal, move->to_normal, t));
        if (k > 0)
            ISO_TRY(enter_piece(search, &piece, reach));
    }
    return ISO_OK;
}

static iso_status enter_move(exact_search *search, int32_t at) {
    const exact_move *move = search->move + at;
    way_section section[WAY_SECTIONS];
    int sections = way_sections(section, &move->move, &move->run, search->tool->model.tip_diameter);
    double reach = reach_of(search->beads, &move->move);
    for (int i = 0; i < sections; i++)
        for (int part = 0; part < TOOL_PARTS; part++)
            if (move->doubt.parts >> part & 1)
                ISO_TRY(enter_section(search, at, &section[i], (tool_part)part, reach));
    return ISO_OK;
}

static bool shape_of(tool_shape *shape, const exact_search *search, const exact_piece *piece,
                     double shrink, double reach) {
    return tool_shape_of(shape, search->tool, piece->part, (double[]){piece->raise, shrink}, reach);
}

/* By how much the part must shrink for it not to meet the bead any more; *place where it then
 * would. */
static double depth_of(iso_vec3 *place, const exact_search *search, const exact_piece *piece,
                       const touch_bead *bead, double reach) {
    double low = CLEARANCE_TOLERANCE, high = 100;
    touch_sweep sweep = piece->sweep, met = piece->sweep;
    (void)shape_of(&met.shape, search, piece, low, reach);
    while (high - low > 1e-4) {
        double middle = (low + high) / 2;
        if (shape_of(&sweep.shape, search, piece, middle, reach) && touch_meets(&sweep, bead)) {
            low = middle;
            met = sweep;
        } else {
            high = middle;
        }
    }
    *place = touch_place(&met, bead);
    return low;
}

/* Where the tip is on its way when it is nearest to a place. */
static iso_vec3 tip_near(const clearance_move *move, iso_vec3 place) {
    iso_vec3 way = vec3_minus(move->to, move->from);
    double length = vec3_dot(way, way);
    double t = length > 0 ? vec3_dot(vec3_minus(place, move->from), way) / length : 0;
    return vec3_between(move->from, move->to, least_of(1, most_of(0, t)));
}

/* Does the bead's box meet what was asked for? */
static bool is_near(const clearance_move *bead, const float *box) {
    double low[3], high[3];
    beads_box(low, high, bead);
    for (int k = 0; k < 3; k++)
        if (low[k] > box[3 + k] || high[k] < box[k])
            return false;
    return true;
}

static void look_at(clearance_hit *hit, bool *found, const exact_search *search, beads_pair pair) {
    const bead_store *beads = search->beads;
    const exact_piece *piece = search->piece + search->of[pair.query];
    const exact_move *move = search->move + piece->move;
    const float *box = search->box + 6 * (int64_t)pair.query;
    for (int64_t i = beads->first[pair.box]; i < beads->first[pair.box + 1]; i++) {
        if (beads_move(beads, i) >= move->index)
            return;
        if (!beads_near(beads, i, box))
            continue;
        clearance_move earlier = beads_get(beads, i);
        if (!is_near(&earlier, box))
            continue;
        touch_bead bead = touch_bead_of(&earlier, search->tool->model.turning == CLEARANCE_UPRIGHT);
        double reach = reach_to(piece, &earlier);
        touch_sweep sweep = piece->sweep;
        if (!shape_of(&sweep.shape, search, piece, CLEARANCE_TOLERANCE, reach) ||
            !touch_meets(&sweep, &bead))
            continue;
        iso_vec3 place;
        double depth = depth_of(&place, search, piece, &bead, reach);
        if (*found && depth <= hit->depth)
            continue;
        *found = true;
        *hit = (clearance_hit){.move = move->index,
                               .bead = beads_move(beads, i),
                               .tip = tip_near(&move->move, place),
                               .place = place,
                               .depth = depth,
                               .part = tool_part_name(piece->part)};
    }
}

static iso_status check_batch(clearance_hit *hit, bool *found, exact_search *search,
                              int32_t count) {
    search->piece_count = search->query_count = 0;
    for (int32_t i = 0; i < count; i++)
        ISO_TRY(enter_move(search, i));
    if (search->query_count == 0)
        return ISO_OK;
    const beads_pair *pair;
    int64_t pairs;
    ISO_TRY(beads_find(&pair, &pairs, search->beads, search->box, (int32_t)search->query_count));
    for (int64_t i = 0; i < pairs; i++) { /* queries go by moves */
        const exact_piece *piece = search->piece + search->of[pair[i].query];
        if (*found && hit->move != search->move[piece->move].index)
            break;
        look_at(hit, found, search, pair[i]);
    }
    return ISO_OK;
}

iso_status exact_check(clearance_hit *hit, bool *found, const tool_body *tool, bead_store *beads,
                       const exact_move *moves, int64_t count) {
    exact_search search = {.tool = tool, .beads = beads};
    iso_status status = ISO_OK;
    *found = false;
    for (int64_t i = 0; beads->count > 0 && i < count && !*found && status == ISO_OK; i += BATCH) {
        search.move = moves + i;
        status = check_batch(hit, found, &search, (int32_t)(count - i < BATCH ? count - i : BATCH));
    }
    iso_release(search.piece);
    iso_release(search.box);
    iso_release(search.of);
    return status;
}
