#include "clearance/reach.h"

#include "base/sort.h"
#include "clearance/tool.h"

/* How far the tool reaches to the sides below its gantry. */
static double side_of(const tool_body *tool) {
    const clearance_tool *model = &tool->model;
    double most = model->tip_diameter / 2 + model->cone_height * tool->tangent;
    const iso_vec2 corner[4] = {model->block_low, model->block_high, model->carriage_low,
                                model->carriage_high};
    for (int i = 0; i < 4; i++)
        most = most_of(most, most_of(fabs(corner[i].x), fabs(corner[i].y)));
    return most;
}

/* Does a box part, from a height on, come over `other` somewhere on `group`? */
static bool box_over(const reach_group *group, const reach_group *other, const iso_vec2 box[2]) {
    return box[0].x < box[1].x && box[0].y < box[1].y && other->low.x < group->high.x + box[1].x &&
           other->high.x > group->low.x + box[0].x && other->low.y < group->high.y + box[1].y &&
           other->high.y > group->low.y + box[0].y;
}

static double gap(double low, double high, double other_low, double other_high) {
    return most_of(0, most_of(other_low - high, low - other_high));
}

/* Would the tool at the group's lowest place touch the other's highest? */
static bool reaches(const tool_body *tool, const reach_group *group, const reach_group *other) {
    const clearance_tool *model = &tool->model;
    double height = other->high.z - group->low.z - CLEARANCE_TOLERANCE;
    if (!(group->low.z < other->low.z) || height <= 0)
        return false;
    double x = gap(group->low.x, group->high.x, other->low.x, other->high.x);
    double y = gap(group->low.y, group->high.y, other->low.y, other->high.y);
    double cone = model->tip_diameter / 2 + least_of(height, model->cone_height) * tool->tangent;
    return x * x + y * y < cone * cone ||
           (height > model->cone_height &&
            box_over(group, other, (iso_vec2[]){model->block_low, model->block_high})) ||
           (height > model->carriage_height &&
            box_over(group, other, (iso_vec2[]){model->carriage_low, model->carriage_high})) ||
           (model->gantry_height > 0 && height > model->gantry_height);
}

/* `before` is to be printed before `group`. */
typedef struct reach_pair {
    int32_t group, before;
} reach_pair;

static inline int pair_less(const reach_pair *a, const reach_pair *b) {
    return a->group != b->group ? a->group < b->group : a->before < b->before;
}

ISO_SORT(sort_pairs, reach_pair, pair_less)

typedef struct reach_side {
    double x;
    int32_t group;
} reach_side;

static inline int side_less(const reach_side *a, const reach_side *b) {
    return a->x != b->x ? a->x < b->x : a->group < b->group;
}

ISO_SORT(sort_sides, reach_side, side_less)

/* All pairs, found from left to right: only those within the tool's reach are looked at, unless the
 * layer is higher than the gantry. Boxes are as wide as the widest. */
static iso_status pairs_of(reach_pair **pair, int64_t *pair_count, const reach_group *group,
                           int32_t count, const tool_body *tool) {
    reach_side *side;
    double widest = 0, low = INFINITY, high = -INFINITY;
    int64_t used = 0, capacity = 0;
    ISO_TRY(ISO_ALLOCATE(side, count));
    for (int32_t i = 0; i < count; i++) {
        side[i] = (reach_side){group[i].low.x, i};
        widest = most_of(widest, group[i].high.x - group[i].low.x);
        low = least_of(low, group[i].low.z);
        high = most_of(high, group[i].high.z);
    }
    sort_sides(side, count);
    double reach = widest + side_of(tool);
    if (tool->model.gantry_height > 0 && high - low > tool->model.gantry_height)
        reach = INFINITY;
    iso_status status = ISO_OK;
    for (int32_t i = 0; i < count && status == ISO_OK; i++)
        for (int32_t k = i + 1; k < count && side[k].x - side[i].x <= reach; k++) {
            int32_t a = side[i].group, b = side[k].group;
            bool first = reaches(tool, &group[a], &group[b]);
            if (!first && !reaches(tool, &group[b], &group[a]))
                continue;
            status = ISO_GROW(*pair, capacity, used + 1);
            if (status != ISO_OK)
                break;
            (*pair)[used++] = first ? (reach_pair){b, a} : (reach_pair){a, b};
        }
    iso_release(side);
    sort_pairs(*pair, used);
    *pair_count = used;
    return status;
}

/* Group by group, each after those that go before it, which wait on a stack of our own: chains may
 * be as long as there are groups. */
static iso_status arrange(int32_t *order, int32_t count, const reach_pair *pair, int64_t pairs,
                          iso_arena *scratch) {
    int64_t *next, end = 0; /* the pair to look at next, of each group */
    int32_t *stack, depth = 0, done = 0;
    bool *seen;
    ISO_TRY(ISO_PUSH(next, scratch, (int64_t)count + 1));
    ISO_TRY(ISO_PUSH(stack, scratch, count));
    ISO_TRY(ISO_PUSH(seen, scratch, count));
    for (int32_t i = 0; i < count; i++) {
        next[i] = end;
        while (end < pairs && pair[end].group == i)
            end++;
        seen[i] = false;
    }
    for (int32_t i = 0; i < count; i++) {
        if (seen[i])
            continue;
        seen[i] = true;
        stack[depth++] = i;
        while (depth > 0) {
            int32_t group = stack[depth - 1];
            if (next[group] == pairs || pair[next[group]].group != group) {
                order[done++] = group;
                depth--;
                continue;
            }
            int32_t before = pair[next[group]++].before;
            if (!seen[before]) {
                seen[before] = true;
                stack[depth++] = before;
            }
        }
    }
    return ISO_OK;
}

iso_status reach_order(int32_t *order, const reach_group *group, int32_t count,
                       const clearance_tool *tool, iso_arena *scratch) {
    tool_body body;
    ISO_TRY(tool_init(&body, tool));
    for (int32_t i = 0; i < count; i++)
        order[i] = i;
    if (tool->turning != CLEARANCE_UPRIGHT || count < 2)
        return ISO_OK;
    reach_pair *pair = NULL;
    int64_t pairs = 0;
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    iso_status status = pairs_of(&pair, &pairs, group, count, &body);
    if (status == ISO_OK && pairs > 0)
        status = arrange(order, count, pair, pairs, scratch);
    iso_release(pair);
    iso_arena_pop(scratch, mark);
    return status;
}
