#include "clearance/clearance.h"

#include "base/memory.h"
#include "clearance/exact.h"
#include "clearance/ground.h"
#include "clearance/room.h"

/* Moves wait until it is known where their run of travels goes. Those close together are looked at
 * as one: all their beads are put on the ground first, which can only make more of them doubtful.
 */
#define STEP_LENGTH 4.0 /* mm: longer pieces of the tip's way are cut */
#define CLUSTER_EXTENT 4.0
#define TURNING_LENGTH 2.0
#define TURNING_ANGLE 0.05 /* radians, about */
enum { WAITING = 512, DOUBTFUL = 1024 };

struct clearance {
    tool_body tool;
    ground_map *ground; /* of an upright tool, else NULL */
    room_map *room;     /* of one that turns, else NULL */
    bead_store beads;
    int64_t count, doubtful_total;
    bool found;
    clearance_hit hit;

    int64_t waiting, waiting_capacity;
    exact_move *move; /* [waiting], the last moves of all */
    int64_t settled;  /* of those, up to and with the last bead: their runs have an end */
    iso_vec3 printed; /* where the last bead ended */
    double printed_height;

    int64_t doubtful, doubtful_capacity;
    exact_move *exact; /* [doubtful] */

    int step_count;
    ground_step step[GROUND_STEPS];
    iso_vec2 low, high; /* of the steps */
};

iso_status clearance_new(clearance **made, const clearance_tool *tool) {
    clearance *check;
    ISO_TRY(ISO_ALLOCATE(check, 1));
    memset(check, 0, sizeof *check);
    iso_status status = tool_init(&check->tool, tool);
    if (status == ISO_OK)
        status = tool->turning == CLEARANCE_UPRIGHT ? ground_new(&check->ground, &check->tool)
                                                    : room_new(&check->room, &check->tool);
    if (status != ISO_OK) {
        clearance_free(check);
        return status;
    }
    *made = check;
    return ISO_OK;
}

void clearance_free(clearance *check) {
    if (!check)
        return;
    ground_free(check->ground);
    room_free(check->room);
    beads_free(&check->beads);
    iso_release(check->move);
    iso_release(check->exact);
    iso_release(check);
}

clearance_cost clearance_cost_of(const clearance *check) {
    int64_t bytes = (int64_t)sizeof *check + beads_bytes(&check->beads) +
                    check->waiting_capacity * (int64_t)sizeof *check->move +
                    check->doubtful_capacity * (int64_t)sizeof *check->exact;
    return (clearance_cost){check->count, check->beads.count, check->doubtful_total,
                            bytes + (check->ground ? ground_bytes(check->ground) : 0) +
                                (check->room ? room_bytes(check->room) : 0)};
}

/* Decide about all that is doubtful so far. Only beads before a move count, so that it doesn't
 * matter when. */
static iso_status decide(clearance *check) {
    if (!check->found)
        ISO_TRY(exact_check(&check->hit, &check->found, &check->tool, &check->beads, check->exact,
                            check->doubtful));
    check->doubtful = 0;
    return ISO_OK;
}

/* Of a move that waits; its steps come one after the other. */
static iso_status doubt(clearance *check, const exact_move *move, const ground_doubt *doubt) {
    exact_move *last = check->doubtful > 0 ? &check->exact[check->doubtful - 1] : NULL;
    if (last && last->index == move->index) {
        ground_doubt_add(&last->doubt, doubt);
        return ISO_OK;
    }
    ISO_TRY(ISO_GROW(check->exact, check->doubtful_capacity, check->doubtful + 1));
    check->exact[check->doubtful] = *move;
    check->exact[check->doubtful++].doubt = *doubt;
    check->doubtful_total++;
    return ISO_OK;
}

/* Ask the ground about the steps that came together. */
static iso_status ask_ground(clearance *check) {
    ground_doubt doubts[GROUND_STEPS];
    ground_check(doubts, check->ground, check->step, check->step_count);
    for (int i = 0; i < check->step_count; i++)
        if (doubts[i].parts)
            ISO_TRY(doubt(check, &check->move[check->step[i].move], &doubts[i]));
    check->step_count = 0;
    return ISO_OK;
}

static iso_status enter_step(clearance *check, const ground_step *step) {
    iso_vec2 low = {least_of(step->from.x, step->to.x), least_of(step->from.y, step->to.y)};
    iso_vec2 high = {most_of(step->from.x, step->to.x), most_of(step->from.y, step->to.y)};
    if (check->step_count > 0) {
        iso_vec2 all_low = {least_of(low.x, check->low.x), least_of(low.y, check->low.y)};
        iso_vec2 all_high = {most_of(high.x, check->high.x), most_of(high.y, check->high.y)};
        if (check->step_count == GROUND_STEPS || all_high.x - all_low.x > CLUSTER_EXTENT ||
            all_high.y - all_low.y > CLUSTER_EXTENT) {
            ISO_TRY(ask_ground(check));
        } else {
            low = all_low;
            high = all_high;
        }
    }
    check->low = low;
    check->high = high;
    check->step[check->step_count++] = *step;
    return ISO_OK;
}

/* Of a section of a move of a tool that turns. */
static iso_status enter_turning(clearance *check, const exact_move *move,
                                const way_section *section) {
    const clearance_move *way = &move->move;
    double length = section->to - section->from;
    double turn = vec3_distance(way->from_normal, way->to_normal) * length;
    double count = 1 + (int)most_of(vec3_distance(way->from, way->to) * length / TURNING_LENGTH,
                                    turn / TURNING_ANGLE);
    tool_pose pose[2];
    for (int i = 0; i <= count; i++) {
        double t = section->from + length * i / count;
        pose[0] = pose[1];
        pose[1] = tool_pose_at(&check->tool, vec3_between(way->from, way->to, t),
                               vec3_between(way->from_normal, way->to_normal, t));
        if (i == 0)
            continue;
        ground_doubt left;
        room_check(&left, check->room, pose, section->raise);
        if (left.parts)
            ISO_TRY(doubt(check, move, &left));
    }
    return ISO_OK;
}

static iso_status enter_upright(clearance *check, const clearance_move *move,
                                const way_section *section, int32_t at) {
    double part = section->to - section->from;
    int count = 1 + (int)(vec3_distance(move->from, move->to) * part / STEP_LENGTH);
    ground_step step = {.to = vec3_between(move->from, move->to, section->from),
                        .raise = section->raise,
                        .move = at};
    for (int k = 1; k <= count; k++) {
        step.from = step.to;
        step.to = vec3_between(move->from, move->to, section->from + part * k / count);
        ISO_TRY(enter_step(check, &step));
    }
    return ISO_OK;
}

static iso_status enter_move(clearance *check, int32_t at) {
    const clearance_move *move = &check->move[at].move;
    clearance_move bead = way_bead(move);
    if (is_bead(move))
        ISO_TRY(beads_add(&check->beads, &bead, check->move[at].index));
    if (is_bead(move) && check->ground)
        ISO_TRY(ground_add(check->ground, &bead));
    way_section section[WAY_SECTIONS];
    int sections =
        way_sections(section, move, &check->move[at].run, check->tool.model.tip_diameter);
    for (int i = 0; i < sections; i++) {
        if (check->ground)
            ISO_TRY(enter_upright(check, move, &section[i], at));
        else
            ISO_TRY(enter_turning(check, &check->move[at], &section[i]));
    }
    return is_bead(move) && check->room ? room_add(check->room, &bead) : ISO_OK;
}

/* Look at the first `count` of the moves that wait. */
static iso_status look_at(clearance *check, int64_t count) {
    for (int64_t i = 0; i < count && !check->found; i++)
        ISO_TRY(enter_move(check, (int32_t)i));
    if (check->step_count > 0)
        ISO_TRY(ask_ground(check));
    check->waiting -= count;
    check->settled -= check->settled < count ? check->settled : count;
    if (count > 0)
        memmove(check->move, check->move + count, (size_t)check->waiting * sizeof *check->move);
    return check->doubtful >= DOUBTFUL ? decide(check) : ISO_OK;
}

/* What isn't of length 1, but for rounding, would be taken for a slope. */
static iso_vec3 unit_or_up(iso_vec3 normal) {
    double square = vec3_dot(normal, normal);
    return square > 0 && square < INFINITY ? vec3_unit(normal) : vec3(0, 0, 1);
}

iso_status clearance_add(clearance *check, const clearance_move *move) {
    ISO_TRY(ISO_GROW(check->move, check->waiting_capacity, check->waiting + 1));
    check->move[check->waiting++] =
        (exact_move){.move = *move,
                     .run = {.begin = check->printed, .begin_height = check->printed_height},
                     .index = check->count++};
    clearance_move *added = &check->move[check->waiting - 1].move;
    added->from_normal = unit_or_up(move->from_normal);
    added->to_normal = unit_or_up(move->to_normal);
    if (!is_bead(move))
        return ISO_OK;
    for (; check->settled < check->waiting; check->settled++) {
        way_run *run = &check->move[check->settled].run;
        run->end = move->from;
        run->end_height = move->height;
    }
    check->printed = move->to;
    check->printed_height = move->height;
    return check->settled >= WAITING ? look_at(check, check->settled) : ISO_OK;
}

iso_status clearance_check(clearance_hit *hit, bool *found, clearance *check, bool last) {
    *found = false;
    ISO_TRY(look_at(check, last ? check->waiting : check->settled));
    ISO_TRY(decide(check));
    *found = check->found;
    if (*found)
        *hit = check->hit;
    return ISO_OK;
}

iso_status clearance_refuse(const clearance_hit *hit) {
    const char *advice =
        hit->part[0] == 'n'
            ? "make the field less steep or layers thicker, or see clearance_tip, clearance_cone"
            : "make the field less steep, or see clearance_block, "
              "clearance_carriage, clearance_gantry_height";
    return iso_fail(ISO_NOT_VERIFIED,
                    "the %s would touch what is printed: with the nozzle at (%.3f, %.3f, %.3f) mm "
                    "(move %lld) it reaches %.3f mm into the line at (%.3f, %.3f, %.3f) mm (move "
                    "%lld): %s",
                    hit->part, hit->tip.x, hit->tip.y, hit->tip.z, (long long)hit->move, hit->depth,
                    hit->place.x, hit->place.y, hit->place.z, (long long)hit->bead, advice);
}
