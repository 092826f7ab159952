#include "gcode/space.h"

#include <math.h>
#include <stdbool.h>

#include "base/vector.h"
#include "gcode/head_parts.h"

enum { UNKNOWN = ISO_HEAD_UNKNOWN, UP = 1000 /* um, of SPACE_CLEARANCE */ };

#define ANGLES 10000.0     /* of POSE_ANGLE in a degree */
#define SWING 30.0         /* degrees that one move of the axes turns at most */
#define FEED_DECIMALS 4    /* of F where the part turns */
#define SHORTEST_TIME 1e-6 /* s: a move takes no less */

/* Where the axes stand. */
typedef struct stand {
    int32_t x, y, z; /* um, z_offset included */
    int64_t angle[2];
    iso_vec3 normal; /* of the layer, unless the angles have it */
} stand;

/* What a move is made for. Without a width it is a travel. */
typedef struct stroke {
    int32_t feed;          /* mm/min of the tip over the part */
    int32_t width, height; /* units */
    const char *comment;
} stroke;

static stand here(const iso_head *head) {
    return (stand){head->x,
                   head->y,
                   head->z == UNKNOWN ? UNKNOWN : to_micrometres(head->z),
                   {head->angle[0], head->angle[1]},
                   head->normal};
}

static bool is_known(const iso_head *head) {
    return head->x != UNKNOWN && head->z != UNKNOWN; /* the angles are with them */
}

static bool is_on_mandrel(const iso_head *head) {
    return head->machine && (head->machine->kinematics == ISO_KINEMATICS_ROTARY_A ||
                             head->machine->kinematics == ISO_KINEMATICS_ROTARY_B);
}

static bool is_same(const stand *a, const stand *b) {
    return a->x == b->x && a->y == b->y && a->z == b->z && a->angle[0] == b->angle[0] &&
           a->angle[1] == b->angle[1];
}

static int32_t micrometres(double mm) {
    return (int32_t)floor(mm * 1000 + 0.5);
}

static stand stand_of(const iso_head *head, const iso_pose *pose) {
    return (stand){micrometres(pose->at.x),
                   micrometres(pose->at.y),
                   micrometres(pose->at.z + iso_mm(head->z_offset)),
                   {(int64_t)floor(pose->angle[0] * ANGLES + 0.5),
                    (int64_t)floor(pose->angle[1] * ANGLES + 0.5)},
                   {0, 0, 1}};
}

static stand flat_stand(const iso_head *head, iso_point at, int32_t z, const iso_frame *frame) {
    return (stand){to_micrometres(at.x),
                   to_micrometres(at.y),
                   to_micrometres(head->layer_z + z),
                   {0, 0},
                   frame ? frame->normal : vec3(0, 0, 1)};
}

static stand vertex_stand(const iso_head *head, const iso_paths *paths, int32_t i) {
    const iso_path_vertex *v = &paths->vertex[i];
    return head->machine ? stand_of(head, &head->pose[i])
                         : flat_stand(head, v->at, v->z, paths->frame ? &paths->frame[i] : NULL);
}

static stand travel_stand(const iso_head *head, const iso_paths *paths, int32_t i) {
    const iso_frame *frame = paths->travel_frame ? &paths->travel_frame[i] : NULL;
    return head->machine ? stand_of(head, &head->travel_pose[i])
                         : flat_stand(head, paths->travel[i], frame ? frame->z : 0, frame);
}

/* A share t of the way that the axes go from a to b. */
static iso_pose pose_between(const iso_head *head, const stand *a, const stand *b, double t) {
    iso_pose pose;
    pose.at = vec3(a->x + t * ((double)b->x - a->x), a->y + t * ((double)b->y - a->y),
                   a->z + t * ((double)b->z - a->z));
    pose.at = vec3_times(pose.at, 1e-3);
    pose.at.z -= iso_mm(head->z_offset);
    for (int i = 0; i < 2; i++)
        pose.angle[i] = ((double)a->angle[i] + t * (double)(b->angle[i] - a->angle[i])) / ANGLES;
    return pose;
}

/* The tip, and where the tool comes from; or, if it always comes from above, the layer's normal. */
static iso_vec3 tip_of(iso_vec3 *normal, const iso_head *head, const stand *at) {
    iso_pose pose = pose_between(head, at, at, 0);
    iso_vec3 tip;
    pose_place(&tip, normal, &pose, head->machine);
    *normal = head->machine ? *normal : at->normal;
    return tip;
}

static double degrees_between(const stand *a, const stand *b, int axis) {
    return fabs((double)(b->angle[axis] - a->angle[axis])) / ANGLES;
}

static double larger(double a, double b) {
    return a > b ? a : b;
}

/* In how many pieces the axes go from a to b, so that the tip stays on its way. How far it strays
 * falls with the square of their number. */
static int32_t pieces(const iso_head *head, const stand *a, const stand *b) {
    if (!head->machine)
        return 1;
    double swing = larger(degrees_between(a, b, 0), degrees_between(a, b, 1));
    if (swing == 0)
        return 1;
    iso_vec3 normal, middle;
    iso_pose pose = pose_between(head, a, b, 0.5);
    pose_place(&middle, &normal, &pose, head->machine);
    iso_vec3 straight =
        vec3_times(vec3_plus(tip_of(&normal, head, a), tip_of(&normal, head, b)), 0.5);
    double by_tip = ceil(1.2 * sqrt(vec3_distance(middle, straight) / SPACE_TOLERANCE) - 0.2);
    return (int32_t)larger(larger(by_tip, ceil(swing / SWING)), 1);
}

/* ---- one move ---- */

static void tell(iso_head *head, const stand *from, const stand *to, const stroke *s) {
    int32_t count = pieces(head, from, to);
    iso_gcode_move move = {.width = iso_mm(s->width), .height = iso_mm(s->height)};
    move.from = tip_of(&move.from_normal, head, from);
    for (int32_t i = 1; i <= count; i++) {
        iso_pose pose = pose_between(head, from, to, (double)i / count);
        if (i < count)
            pose_place(&move.to, &move.to_normal, &pose, head->machine);
        else
            move.to = tip_of(&move.to_normal, head, to);
        head_tell(head, &move);
        move.from = move.to;
        move.from_normal = move.to_normal;
    }
}

/* mm that the axes X, Y and Z go, or the degrees of the others if they don't: what F counts. */
static double counted(const stand *a, const stand *b) {
    double x = (double)b->x - a->x, y = (double)b->y - a->y, z = (double)b->z - a->z;
    double c = degrees_between(a, b, 0), d = degrees_between(a, b, 1);
    double mm = sqrt(x * x + y * y + z * z) / 1000;
    return mm > 0 ? mm : sqrt(c * c + d * d);
}

/* s of a move, as fast as the tip is to go, and as all axes can. */
static double time_of(const iso_head *head, const stand *a, const stand *b, double tip_mm,
                      int32_t feed) {
    const double *fastest = head->options->limits.feedrate;
    double time = larger(60 * tip_mm / feed, SHORTEST_TIME);
    const double mm[3] = {fabs((double)b->x - a->x) / 1000, fabs((double)b->y - a->y) / 1000,
                          fabs((double)b->z - a->z) / 1000};
    for (int i = 0; i < 3; i++)
        time = fastest[i] > 0 ? larger(time, mm[i] / fastest[i]) : time;
    for (int i = 0; i < 2; i++)
        time = larger(time, degrees_between(a, b, i) / head->machine->fastest[i]);
    return time;
}

/* F of a move that turns the part, rounded down: no axis is to be driven too fast. About four
 * digits, since small moves of X, Y and Z may go along with large ones of the part. */
static char *put_fine_feed(iso_head *head, char *p, const stand *a, const stand *b, double time) {
    int inverse = head->options->rotary_feed == ISO_FEED_INVERSE_TIME;
    double feed = 60 * (inverse ? 1 : counted(a, b)) / time;
    int64_t digits = (int64_t)larger(floor(feed * 1e4 + 0.01), 1); /* 0.01: of roundings */
    int64_t coarse = digits >= 100000000 ? 100000 : digits >= 10000000 ? 10000 : 100;
    digits -= digits >= 100000 ? digits % coarse : 0;
    if (!inverse && digits == head->fine_feed)
        return p;
    head->fine_feed = digits;
    head->feed = UNKNOWN;
    return iso_put_decimal(ISO_PUT(p, " F"), digits, FEED_DECIMALS);
}

/* The most that X, Y and Z let the tip accelerate. */
static double acceleration_limit(const iso_head *head, const stand *a, const stand *b,
                                 double tip_mm) {
    const double *most = head->options->limits.acceleration;
    const double mm[3] = {fabs((double)b->x - a->x) / 1000, fabs((double)b->y - a->y) / 1000,
                          fabs((double)b->z - a->z) / 1000};
    double limit = INFINITY;
    for (int i = 0; i < 3; i++)
        if (mm[i] > 0 && most[i] > 0 && most[i] * tip_mm / mm[i] < limit)
            limit = most[i] * tip_mm / mm[i];
    return limit;
}

/* The estimate follows the tip over the part. Where only the part turns about it, the time counts
 * alone. */
static void plan(iso_head *head, const stand *from, const stand *to, const stroke *s, double time) {
    iso_vec3 normal,
        by = {(to->x - from->x) / 1000.0, (to->y - from->y) / 1000.0, (to->z - from->z) / 1000.0};
    if (head->machine)
        by = vec3_minus(tip_of(&normal, head, to), tip_of(&normal, head, from));
    double mm = vec3_length(by), delta[3] = {by.x, by.y, by.z}, still[3] = {0, 0, 0};
    *(s->width > 0 ? &head->bead_mm : &head->travel_mm) += mm;
    if (!head->machine)
        head_plan(head, delta, mm, head->speed, s->width > 0, INFINITY);
    else if (mm < 1e-6)
        head_plan(head, still, 10 * time, 10, s->width > 0, INFINITY);
    else
        head_plan(head, delta, mm, mm / time, s->width > 0, acceleration_limit(head, from, to, mm));
}

static char *put_axes(const iso_head *head, char *p, const stand *from, const stand *to) {
    p = ISO_PUT(p, "G1");
    if (to->x != from->x || to->y != from->y || head->doubtful) {
        p = iso_put_thousandths(ISO_PUT(p, " X"), to->x);
        p = iso_put_thousandths(ISO_PUT(p, " Y"), to->y);
    }
    if (to->z != from->z)
        p = iso_put_thousandths(ISO_PUT(p, " Z"), to->z);
    for (int i = 0; i < 2; i++) {
        const char *letter = pose_letter(head->machine, i);
        if (!*letter || to->angle[i] == from->angle[i])
            continue;
        *p++ = ' ';
        *p++ = *letter;
        p = iso_put_decimal(p, to->angle[i], 4);
    }
    return p;
}

/* While a mandrel turns, X, Y and Z stay where they are if they are right within SPACE_STILL: a
 * firmware whose F counts them would else brake for a move of some um that is but rounding. A
 * table's move with all that turns, and would brake where they stay. */
static stand steadied(const stand *from, const stand *to) {
    stand steady = *to;
    int32_t *axis[3] = {&steady.x, &steady.y, &steady.z};
    const int32_t old[3] = {from->x, from->y, from->z};
    if (from->angle[0] == to->angle[0] && from->angle[1] == to->angle[1])
        return steady;
    for (int i = 0; i < 3; i++)
        if (*axis[i] - old[i] >= -SPACE_STILL && *axis[i] - old[i] <= SPACE_STILL)
            *axis[i] = old[i];
    return steady;
}

/* All axes straight to where they are to stand; the E that is due goes along with a bead. */
static void go(iso_head *head, const stand *goal, const stroke *s) {
    stand from = here(head);
    stand steady = is_on_mandrel(head) && is_known(head) ? steadied(&from, goal) : *goal;
    const stand *to = &steady;
    bool known = is_known(head), timed = head->machine && known && !head->doubtful;
    iso_vec3 normal;
    double time = 0;
    if (is_same(&from, to) && !head->doubtful)
        return;
    if (timed && head->options->rotary_feed == ISO_FEED_INVERSE_TIME && !head->inverse) {
        iso_modes_say(&head->modes, "G93", 0, "F is one over the minutes of a move");
        head->inverse = 1;
    }
    if (!timed)
        iso_head_end_inverse_time(head);
    char *p = put_axes(head, iso_lines_reserve(head->lines), &from, to);
    int64_t e = s->width > 0 ? take_e(head) : 0;
    if (e != 0)
        p = put_e(head, p, e);
    if (head->machine && known) {
        double mm = vec3_distance(tip_of(&normal, head, &from), tip_of(&normal, head, to));
        time = time_of(head, &from, to, mm, s->feed);
    }
    if (timed) {
        p = put_fine_feed(head, p, &from, to, time);
    } else {
        p = put_feed(head, p, s->feed);
        head->fine_feed = 0;
    }
    iso_lines_accept(head->lines, iso_modes_end_line(&head->modes, p, s->comment));
    if (known && !is_same(&from, to))
        plan(head, &from, to, s, time);
    if (known && head->options->watch)
        tell(head, &from, to, s);
    if (to->x != UNKNOWN)
        head->doubtful = 0;
    head->x = to->x;
    head->y = to->y;
    head->z = to->z * 10;
    head->angle[0] = to->angle[0];
    head->angle[1] = to->angle[1];
    head->normal = to->normal;
}

/* Straight over the part, however a table turns it; `volume` is the E to leave there. On a mandrel
 * the axes go straight: the tip then keeps its distance from the axis, or changes it evenly, and
 * that is nearer to the layer than a chord of it. */
static void go_over(iso_head *head, const stand *to, const stroke *s, double volume) {
    stand from = here(head);
    int32_t count = is_on_mandrel(head) ? 1 : pieces(head, &from, to);
    iso_vec3 normal, begin, end;
    if (count > 1) {
        begin = tip_of(&normal, head, &from);
        end = tip_of(&normal, head, to);
    }
    for (int32_t i = 1; i <= count; i++) {
        double t = (double)i / count;
        stand next = *to;
        if (i < count) {
            iso_pose pose = pose_between(head, &from, to, t);
            for (int k = 0; k < 2; k++)
                pose.angle[k] = floor(pose.angle[k] * ANGLES + 0.5) / ANGLES;
            pose.at = pose_turn(vec3_between(begin, end, t), pose.angle, head->machine);
            next = stand_of(head, &pose);
        }
        head->drawn += (int64_t)(volume * t + 0.5) - (int64_t)(volume * (i - 1.0) / count + 0.5);
        go(head, &next, s);
    }
}

/* ---- travel ---- */

int32_t iso_space_height_above_all(const iso_head *head) {
    return head->highest + 10 * UP;
}

static double from_axis(const iso_head *head, iso_vec3 at) {
    iso_vec3 arm = vec3_minus(at, head->machine->pivot);
    if (head->machine->kinematics == ISO_KINEMATICS_ROTARY_A)
        arm.x = 0;
    if (head->machine->kinematics == ISO_KINEMATICS_ROTARY_B)
        arm.y = 0;
    return vec3_length(arm);
}

/* um: where nothing printed is in the way of the part's turning, or of going across. At least
 * `least`. */
static int32_t height_around(const iso_head *head, int32_t least) {
    int32_t z = least;
    if (head->machine && head->reach >= 0)
        z = micrometres(head->machine->pivot.z + head->reach) + to_micrometres(head->z_offset) + UP;
    if (!head->machine && head->highest != UNKNOWN)
        z = to_micrometres(iso_space_height_above_all(head));
    return z > least ? z : least;
}

static void rise(iso_head *head, int32_t z) {
    stand up = here(head);
    if (up.z != UNKNOWN && up.z >= z)
        return;
    up.z = z;
    int doubtful = head->doubtful;
    head->doubtful = 0; /* the place is said on the way across */
    go(head, &up, &(stroke){.feed = head->travel_feed_z, .comment = "above all"});
    head->doubtful = doubtful;
}

void iso_space_rise(iso_head *head) {
    rise(head, height_around(head, INT32_MIN / 2));
}

static void go_around(iso_head *head, const stand *to) {
    bool first = head->machine ? head->reach < 0 : head->highest == UNKNOWN;
    int32_t lift = first && !head->machine ? to_micrometres(head->lift) : UP;
    rise(head, height_around(head, to->z + lift));
    stand over = *to;
    over.z = to_micrometres(head->z);
    go(head, &over, &(stroke){.feed = head->travel_feed, .comment = "travel"});
    go(head, to, &(stroke){.feed = head->travel_feed_z, .comment = "to the layer"});
}

/* Point i of the way to a path, which ends where the path begins. */
static stand way_stand(const iso_head *head, const iso_paths *paths, const iso_path *path,
                       int32_t i, const stand *end) {
    return i < path->travel_count ? travel_stand(head, paths, path->travel_first + i) : *end;
}

/* Does the way anywhere turn a table so far that the tip had better not stay near the part? */
static bool swings(const iso_head *head, const iso_paths *paths, const iso_path *path,
                   const stand *end) {
    stand from = here(head);
    iso_vec3 before, after;
    if (!head->machine || is_on_mandrel(head))
        return false;
    tip_of(&before, head, &from);
    for (int32_t i = 0; i <= path->travel_count; i++) {
        stand next = way_stand(head, paths, path, i, end);
        tip_of(&after, head, &next);
        if (vec3_dot(before, after) < SPACE_TURN)
            return true;
        before = after;
    }
    return false;
}

static void go_along(iso_head *head, const iso_paths *paths, const iso_path *path,
                     const stand *end) {
    const stroke s = {.feed = head->travel_feed, .comment = "travel"};
    for (int32_t i = 0; i <= path->travel_count; i++) {
        stand next = way_stand(head, paths, path, i, end);
        go_over(head, &next, &s, 0);
    }
}

/* How far the nozzle goes before it drips where it is seen: along the layer, without the ways up
 * from it and down again at both ends. */
static double mm_along_layer(const iso_head *head, const iso_paths *paths, const iso_path *path,
                             const stand *to) {
    stand from = here(head);
    iso_vec3 normal, at = tip_of(&normal, head, &from);
    double straight = vec3_distance(at, tip_of(&normal, head, to)), sum = 0;
    for (int32_t i = 0; i < path->travel_count; i++) {
        stand step = travel_stand(head, paths, path->travel_first + i);
        iso_vec3 next = tip_of(&normal, head, &step);
        sum += i > 0 ? vec3_distance(at, next) : 0;
        at = next;
    }
    return larger(straight, sum);
}

static void travel(iso_head *head, const iso_paths *paths, const iso_path *path, const stand *to) {
    stand from = here(head);
    bool known = is_known(head), away = !known || head->doubtful || !is_same(&from, to);
    if (!known || (away && path->retract != ISO_RETRACT_NOT &&
                   mm_along_layer(head, paths, path, to) > head->options->retract_before_travel))
        iso_head_retract(head);
    if (away) {
        iso_modes_accelerate_travel(&head->modes, head->travel_acceleration);
        if (!known || path->travel_count == 0 || head->above != UNKNOWN ||
            swings(head, paths, path, to))
            go_around(head, to);
        else
            go_along(head, paths, path, to);
    }
    head->above = UNKNOWN;
    head_deretract(head);
}

/* ---- beads ---- */

static bool differs(int32_t value, int32_t said) {
    return said == UNKNOWN || fabs((double)value - said) > SPACE_SAID * said;
}

static void say_bead(iso_head *head, int32_t width, int32_t height) {
    char *p = iso_lines_reserve(head->lines);
    if (differs(width, head->width)) {
        p = iso_put_newline(iso_put_decimal(ISO_PUT(p, ";WIDTH:"), width, 4));
        head->width = width;
    }
    if (differs(height, head->height)) {
        p = iso_put_newline(iso_put_decimal(ISO_PUT(p, ";HEIGHT:"), height, 4));
        head->height = height;
    }
    iso_lines_accept(head->lines, p);
}

static iso_vec3 place_of(const iso_head *head, const iso_path_vertex *v) {
    return vec3(iso_mm(v->at.x), iso_mm(v->at.y),
                iso_mm((int64_t)head->layer_z - head->z_offset + v->z));
}

/* What has been printed reaches to the vertex. */
static void reach(iso_head *head, const iso_path_vertex *v) {
    int32_t z = head->layer_z + v->z;
    head->highest = head->highest == UNKNOWN || z > head->highest ? z : head->highest;
    if (head->machine)
        head->reach = larger(head->reach, from_axis(head, place_of(head, v)));
}

/* Where a closed path ends: a turning axis may have gone around. */
static iso_status closing_stand(stand *end, const iso_head *head, const iso_paths *paths,
                                const iso_path *path) {
    iso_pose pose;
    *end = vertex_stand(head, paths, path->first);
    if (!head->machine)
        return ISO_OK;
    iso_vec3 normal = paths->frame ? paths->frame[path->first].normal : vec3(0, 0, 1);
    ISO_TRY(pose_at(&pose, &head->pose[path->first + path->count - 1],
                    place_of(head, &paths->vertex[path->first]), normal, head->machine));
    *end = stand_of(head, &pose);
    return ISO_OK;
}

iso_status iso_space_draw(iso_head *head, const iso_paths *paths, const iso_path *path,
                          const double *length, const iso_layer_pace *pace) {
    const iso_path_vertex *vertex = paths->vertex + path->first;
    int32_t segments = path->closed ? path->count : path->count - 1, role = UNKNOWN;
    int slot = 0;
    stand end = {0}, first = vertex_stand(head, paths, path->first);
    if (path->closed)
        ISO_TRY(closing_stand(&end, head, paths, path));
    head->wipe.count = 0;
    head_blow(head, vertex[0].role, pace); /* it takes a while to turn faster */
    travel(head, paths, path, &first);
    reach(head, &vertex[0]);
    for (int32_t i = 0; i < segments; i++) {
        const iso_path_vertex *from = &vertex[i];
        stand to = i + 1 < path->count ? vertex_stand(head, paths, path->first + i + 1) : end;
        if (from->role != role) {
            role = from->role;
            slot = iso_speed_slot(role, path->speed_class);
            head_begin_piece(head, role, pace);
        }
        int32_t local = paths->frame ? paths->frame[path->first + i].height : head->layer_height;
        stroke s = {.feed = from->area > pace->most_area[slot]
                                ? iso_pace_limited_feed(pace, slot, from->area)
                                : pace->feed[slot],
                    .width = from->width,
                    .height = head_height_of(from, local),
                    .comment = head_comment_of(role)};
        say_bead(head, s.width, s.height);
        go_over(head, &to, &s, length[i] * from->area * head->e_scale);
        reach(head, &vertex[i + 1 < path->count ? i + 1 : 0]);
    }
    return ISO_OK;
}
