#include "pose/pose.h"

#include <math.h>

#include "base/angle.h"
#include "base/series.h"
#include "base/vector.h"

enum { TILT, TURN, ANGLES_A_DEGREE = 10000 };

#define DEGREE (3.14159265358979323846 / 180)
#define HALF_TURN 180.001 /* degrees: no two normals are further apart, roundings included */

/* ---- turning ---- */

/* Right-handed around x, y, z; s and c are sine and cosine. */
static iso_vec3 around_x(iso_vec3 v, double s, double c) {
    return vec3(v.x, v.y * c - v.z * s, v.y * s + v.z * c);
}
static iso_vec3 around_y(iso_vec3 v, double s, double c) {
    return vec3(v.x * c + v.z * s, v.y, v.z * c - v.x * s);
}
static iso_vec3 around_z(iso_vec3 v, double s, double c) {
    return vec3(v.x * c - v.y * s, v.x * s + v.y * c, v.z);
}

static iso_vec3 turned(iso_vec3 v, const double angle[2], iso_kinematics kinematics) {
    double s, c;
    iso_sine_cosine(&s, &c, angle[TURN]);
    if (kinematics == ISO_KINEMATICS_ROTARY_A)
        return around_x(v, s, c);
    if (kinematics == ISO_KINEMATICS_ROTARY_B)
        return around_y(v, s, c);
    v = around_z(v, s, c);
    iso_sine_cosine(&s, &c, angle[TILT]);
    return kinematics == ISO_KINEMATICS_TABLE_AC ? around_x(v, s, c) : around_y(v, s, c);
}

static iso_vec3 turned_back(iso_vec3 v, const double angle[2], iso_kinematics kinematics) {
    double s, c;
    iso_sine_cosine(&s, &c, angle[TURN]);
    if (kinematics == ISO_KINEMATICS_ROTARY_A)
        return around_x(v, -s, c);
    if (kinematics == ISO_KINEMATICS_ROTARY_B)
        return around_y(v, -s, c);
    double tilt_s, tilt_c;
    iso_sine_cosine(&tilt_s, &tilt_c, angle[TILT]);
    v = kinematics == ISO_KINEMATICS_TABLE_AC ? around_x(v, -tilt_s, tilt_c)
                                              : around_y(v, -tilt_s, tilt_c);
    return around_z(v, -s, c);
}

bool pose_turns(const pose_machine *machine) {
    return machine && machine->kinematics != ISO_KINEMATICS_CARTESIAN;
}

const char *pose_letter(const pose_machine *machine, int axis) {
    static const char *const letter[][2] = {[ISO_KINEMATICS_CARTESIAN] = {"", ""},
                                            [ISO_KINEMATICS_ROTARY_A] = {"", "A"},
                                            [ISO_KINEMATICS_ROTARY_B] = {"", "B"},
                                            [ISO_KINEMATICS_TABLE_AC] = {"A", "C"},
                                            [ISO_KINEMATICS_TABLE_BC] = {"B", "C"}};
    return letter[machine ? machine->kinematics : ISO_KINEMATICS_CARTESIAN][axis];
}

iso_vec3 pose_turn(iso_vec3 at, const double angle[2], const pose_machine *machine) {
    if (!pose_turns(machine))
        return at;
    iso_vec3 arm = vec3_minus(at, machine->pivot);
    return vec3_plus(machine->pivot, turned(arm, angle, machine->kinematics));
}

void pose_place(iso_vec3 *at, iso_vec3 *normal, const iso_pose *pose, const pose_machine *machine) {
    *at = pose->at;
    *normal = vec3(0, 0, 1);
    if (!pose_turns(machine))
        return;
    iso_vec3 arm = vec3_minus(pose->at, machine->pivot);
    *at = vec3_plus(machine->pivot, turned_back(arm, pose->angle, machine->kinematics));
    *normal = turned_back(*normal, pose->angle, machine->kinematics);
}

/* ---- the angles for a normal ---- */

static double rounded(double degrees) {
    return floor(degrees * ANGLES_A_DEGREE + 0.5) / ANGLES_A_DEGREE;
}

static double degrees_of(double y, double x) {
    return series_arctangent2(y, x) / DEGREE;
}

/* The same position of the turning axis nearest to `last` within its limits. */
static bool unwind(double *turn, double last, const pose_machine *machine) {
    double low = machine->low[TURN], high = machine->high[TURN];
    double at = *turn + 360 * floor((last - *turn) / 360 + 0.5);
    if (at > high)
        at -= 360 * ceil((at - high) / 360);
    if (at < low)
        at += 360 * ceil((low - at) / 360);
    *turn = at;
    return at <= high;
}

/* How far the table has to tilt once the normal has been turned. */
static double tilt_for(iso_vec3 normal, double turn, iso_kinematics kinematics) {
    double s, c;
    iso_sine_cosine(&s, &c, turn);
    normal = around_z(normal, s, c);
    return kinematics == ISO_KINEMATICS_TABLE_AC ? degrees_of(normal.y, normal.z)
                                                 : -degrees_of(normal.x, normal.z);
}

/* What turns the normal up, in up to two ways; how many there are. */
static int ways_up(double way[2][2], iso_vec3 normal, const iso_pose *last,
                   const pose_machine *machine) {
    iso_kinematics kinematics = machine->kinematics;
    const double pole = POSE_POLE * DEGREE;
    way[0][TILT] = way[1][TILT] = 0;
    if (kinematics == ISO_KINEMATICS_ROTARY_A || kinematics == ISO_KINEMATICS_ROTARY_B) {
        bool a = kinematics == ISO_KINEMATICS_ROTARY_A;
        double across = a ? normal.y : -normal.x;
        bool known = across * across + normal.z * normal.z >= pole * pole;
        way[0][TURN] = known ? degrees_of(across, normal.z) : last->angle[TURN];
        return 1;
    }
    bool known = normal.x * normal.x + normal.y * normal.y >= pole * pole;
    double toward = kinematics == ISO_KINEMATICS_TABLE_AC ? 90 : 0;
    double turn = known ? toward - degrees_of(normal.y, normal.x) : last->angle[TURN];
    for (int i = 0; i < 2; i++) {
        way[i][TURN] = rounded(turn + 180 * i);
        way[i][TILT] = tilt_for(normal, way[i][TURN], kinematics);
    }
    return known ? 2 : 1;
}

static double larger(double a, double b) {
    return a > b ? a : b;
}

/* s to turn from one to the other. */
static double time_between(const double a[2], const double b[2], const pose_machine *machine) {
    return larger(fabs(a[TILT] - b[TILT]) / machine->fastest[TILT],
                  fabs(a[TURN] - b[TURN]) / machine->fastest[TURN]);
}

static iso_status beyond(iso_vec3 at, const double way[2], int axis, const pose_machine *machine) {
    return iso_fail(ISO_OUTSIDE,
                    "at x = %.3f, y = %.3f, z = %.3f mm the layer asks for %s = %.2f degrees, and "
                    "%s is from %g to %g",
                    at.x, at.y, at.z, pose_letter(machine, axis), way[axis],
                    axis == TILT ? "tilt_limits" : "turn_limits", machine->low[axis],
                    machine->high[axis]);
}

iso_status pose_at(iso_pose *pose, const iso_pose *last, iso_vec3 at, iso_vec3 normal,
                   const pose_machine *machine) {
    if (!pose_turns(machine)) {
        *pose = (iso_pose){.at = at};
        return ISO_OK;
    }
    double way[2][2], least = INFINITY;
    int best = -1, hindered = TILT, ways = ways_up(way, normal, last, machine);
    for (int i = 0; i < ways; i++) {
        way[i][TILT] = rounded(way[i][TILT]);
        way[i][TURN] = rounded(way[i][TURN]);
        bool turns = unwind(&way[i][TURN], last->angle[TURN], machine);
        bool tilts = ways < 2 && machine->kinematics <= ISO_KINEMATICS_ROTARY_B;
        tilts |= way[i][TILT] >= machine->low[TILT] && way[i][TILT] <= machine->high[TILT];
        if (tilts && !turns)
            hindered = TURN;
        double time = time_between(way[i], last->angle, machine);
        if (!tilts || !turns || time >= least)
            continue;
        least = time;
        best = i;
    }
    if (best < 0)
        return beyond(at, way[0], hindered, machine);
    pose->angle[TILT] = way[best][TILT];
    pose->angle[TURN] = rounded(way[best][TURN]);
    pose->at = pose_turn(at, pose->angle, machine);
    return ISO_OK;
}

/* ---- paths ---- */

/* While a bead is drawn no axis can be wound back. */
static iso_status check_winding(const iso_pose *from, const iso_pose *to, iso_vec3 at,
                                const pose_machine *machine) {
    if (fabs(to->angle[TURN] - from->angle[TURN]) <= HALF_TURN)
        return ISO_OK;
    return iso_fail(ISO_OUTSIDE,
                    "at x = %.3f, y = %.3f, z = %.3f mm %s is turned as far as turn_limits allow, "
                    "%g to %g degrees, in the middle of a line",
                    at.x, at.y, at.z, pose_letter(machine, TURN), machine->low[TURN],
                    machine->high[TURN]);
}

/* Layers that lie around another axis than the mandrel's have such beads. */
static iso_status check_lean(iso_vec3 normal, iso_vec3 at, const pose_machine *machine) {
    bool a = machine->kinematics == ISO_KINEMATICS_ROTARY_A;
    double sine, cosine, along = fabs(a ? normal.x : normal.y);
    if (!a && machine->kinematics != ISO_KINEMATICS_ROTARY_B)
        return ISO_OK;
    iso_sine_cosine(&sine, &cosine, POSE_LEAN);
    if (along <= sine)
        return ISO_OK;
    return iso_fail(ISO_OUTSIDE,
                    "at x = %.3f, y = %.3f, z = %.3f mm the layer leans by %.0f degrees along the "
                    "mandrel, and %s can't turn it up: it takes a field whose layers lie around "
                    "the %s axis",
                    at.x, at.y, at.z, degrees_of(along, sqrt(fmax(0, 1 - along * along))),
                    pose_letter(machine, TURN), a ? "x" : "y");
}

static iso_vec3 place_of(iso_point at, int64_t z) {
    return vec3(iso_mm(at.x), iso_mm(at.y), iso_mm(z));
}

static iso_status pose_path(iso_pose *vertex, iso_pose *travel, iso_pose *last,
                            const iso_paths *paths, const iso_path *path, int32_t z,
                            const pose_machine *machine) {
    const iso_vec3 up = {0, 0, 1};
    for (int32_t i = path->travel_first; i < path->travel_first + path->travel_count; i++) {
        const iso_frame *frame = paths->travel_frame ? &paths->travel_frame[i] : NULL;
        iso_vec3 at = place_of(paths->travel[i], (int64_t)z + (frame ? frame->z : 0));
        ISO_TRY(pose_at(&travel[i], last, at, frame ? frame->normal : up, machine));
        *last = travel[i];
    }
    for (int32_t k = 0; k < path->count + path->closed; k++) {
        int32_t i = path->first + (k < path->count ? k : 0);
        iso_vec3 at = place_of(paths->vertex[i].at, (int64_t)z + paths->vertex[i].z);
        iso_vec3 normal = paths->frame ? paths->frame[i].normal : up;
        iso_pose here;
        ISO_TRY(check_lean(normal, at, machine));
        ISO_TRY(pose_at(&here, last, at, normal, machine));
        if (k > 0)
            ISO_TRY(check_winding(last, &here, at, machine));
        *last = here;
        if (k < path->count)
            vertex[i] = here;
    }
    return ISO_OK;
}

/* The turning axis as it stands, whole turns taken back to about the middle of its limits. */
static iso_pose wound_back(const iso_pose *pose, const pose_machine *machine) {
    iso_pose back = *pose;
    double middle = (machine->low[TURN] + machine->high[TURN]) / 2;
    back.angle[TURN] -= 360 * floor((pose->angle[TURN] - middle) / 360 + 0.5);
    return back;
}

iso_status pose_paths(iso_pose *vertex, iso_pose *travel, iso_pose *last, const iso_paths *paths,
                      int32_t z, const pose_machine *machine) {
    iso_pose at = *last;
    for (int32_t i = 0; i < paths->count; i++) {
        const iso_path *path = &paths->path[i];
        if (path->count < 2) { /* nobody goes there */
            for (int32_t k = 0; k < path->count; k++)
                vertex[path->first + k] = at;
            continue;
        }
        iso_pose begun = at;
        iso_status status = pose_path(vertex, travel, &at, paths, path, z, machine);
        if (status == ISO_OUTSIDE && pose_turns(machine)) {
            at = wound_back(&begun, machine);
            status = pose_path(vertex, travel, &at, paths, path, z, machine);
        }
        ISO_TRY(status);
    }
    *last = at;
    return ISO_OK;
}
