/* ns a move of a synthetic print: layers like domes, cones or plates, in stripes of short moves.
 * Not a test of its own; its figures go by hand. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "check.h"
#include "scene.h"

static scene_plan plan;

/* z of the layer at r = 0 and its slopes. */
static double shape(iso_vec3 *normal, int kind, double steep, double x, double y) {
    double r = sqrt(x * x + y * y);
    double gx = 0, gy = 0, z = 0;
    if (kind == 1) { /* dome: as steep as said at 30 mm */
        z = -steep * r * r / 60;
        gx = -steep * x / 30;
        gy = -steep * y / 30;
    } else if (kind >= 2) { /* cone, upwards or downwards */
        double slope = kind == 2 ? -steep : steep;
        z = slope * r;
        gx = r > 0 ? slope * x / r : 0;
        gy = r > 0 ? slope * y / r : 0;
    }
    *normal = vec3_unit(vec3(-gx, -gy, 1));
    return z;
}

static void stripes(int kind, double steep, int count) {
    scene_start(&plan, 0.45, 0.2);
    for (int layer = 1; plan.count < count; layer++)
        for (int i = -60; i <= 60; i++) {
            double half = sqrt(fmax(0, 900 - 0.2025 * i * i));
            int parts = 1 + (int)(2 * half / 1.0);
            for (int k = 0; k <= parts && plan.count < count; k++) {
                double along = (2.0 * k / parts - 1) * half * (i % 2 ? 1 : -1), across = 0.45 * i;
                double x = layer % 2 ? along : across, y = layer % 2 ? across : along;
                iso_vec3 normal;
                double z = 20 + layer * 0.2 + shape(&normal, kind, steep, x, y);
                if (k == 0) {
                    if (i == -60) { /* over all there is */
                        scene_travel(&plan, plan.at.x, plan.at.y, z + 20);
                        scene_travel(&plan, x, y, z + 20);
                    }
                    scene_travel(&plan, x, y, z + 0.3);
                    scene_travel(&plan, x, y, z);
                } else {
                    scene_print(&plan, x, y, z);
                }
                plan.move[plan.count - 1].from_normal = plan.normal;
                plan.move[plan.count - 1].to_normal = plan.normal = normal;
            }
        }
}

int main(int argc, char **argv) {
    static const char *const names[] = {"plate", "dome", "cone down", "cone up"};
    for (int kind = 0; kind < 4; kind++)
        for (int degrees = kind ? 10 : 0; degrees <= (kind ? 25 : 0); degrees += 5) {
            stripes(kind, tan(degrees * 3.14159265358979 / 180), 300000);
            clearance_tool tool = scene_tool();
            if (argc > 2 && (kind != atoi(argv[2]) || degrees != atoi(argv[3])))
                continue;
            if (argc > 1)
                tool.turning = (clearance_turning)atoi(argv[1]);
            clearance *check;
            clearance_hit hit;
            bool found;
            clock_t start = clock();
            CHECK_OK(clearance_new(&check, &tool));
            for (int i = 0; i < plan.count; i++)
                CHECK_OK(clearance_add(check, &plan.move[i]));
            CHECK_OK(clearance_check(&hit, &found, check, true));
            double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
            clearance_cost cost = clearance_cost_of(check);
            printf(
                "%-10s %2d deg: %6.0f ns a move, %lld of %lld doubtful, %.1f bytes a bead, %s%.3f %s\n",
                names[kind], degrees, seconds * 1e9 / plan.count, (long long)cost.doubtful,
                (long long)cost.moves, (double)cost.bytes / (double)cost.beads,
                found ? "hit " : "free ", found ? hit.depth : 0, found ? hit.part : "");
            clearance_free(check);
        }
    return check_verdict();
}
