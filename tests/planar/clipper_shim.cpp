#include "clipper_shim.h"

#include <new>
#include <polyclipping/clipper.hpp>

using namespace ClipperLib;

struct clipper_paths {
    Paths paths;
};

namespace {

/* No exception may pass into C. */
template <typename Work> clipper_paths *guarded(Work work) {
    clipper_paths *out = nullptr;
    try {
        out = new clipper_paths;
        work(out->paths);
        return out;
    } catch (...) {
        delete out;
        return nullptr;
    }
}

PolyFillType fill_type(iso_fill_rule rule) {
    return rule == ISO_FILL_POSITIVE  ? pftPositive
           : rule == ISO_FILL_NONZERO ? pftNonZero
                                      : pftEvenOdd;
}

ClipType clip_type(iso_boolean_kind kind) {
    return kind == ISO_UNION          ? ctUnion
           : kind == ISO_INTERSECTION ? ctIntersection
           : kind == ISO_DIFFERENCE   ? ctDifference
                                      : ctXor;
}

JoinType join_type(iso_join join) {
    return join == ISO_JOIN_ROUND ? jtRound : join == ISO_JOIN_MITRE ? jtMiter : jtSquare;
}

} // namespace

clipper_paths *clipper_from_region(const iso_region *region) {
    return guarded([&](Paths &out) {
        out.resize(static_cast<size_t>(region->count));
        for (int32_t i = 0; i < region->count; i++)
            for (int32_t k = region->first[i]; k < region->first[i + 1]; k++)
                out[static_cast<size_t>(i)].emplace_back(region->point[k].x, region->point[k].y);
    });
}

void clipper_free(clipper_paths *paths) {
    delete paths;
}

clipper_paths *clipper_clean(const clipper_paths *in, iso_fill_rule rule) {
    return guarded([&](Paths &out) {
        Clipper clipper;
        clipper.AddPaths(in->paths, ptSubject, true);
        clipper.Execute(ctUnion, out, fill_type(rule), fill_type(rule));
    });
}

clipper_paths *clipper_boolean(iso_boolean_kind kind, const clipper_paths *a,
                               const clipper_paths *b) {
    return guarded([&](Paths &out) {
        Clipper clipper;
        clipper.AddPaths(a->paths, ptSubject, true);
        clipper.AddPaths(b->paths, ptClip, true);
        clipper.Execute(clip_type(kind), out, pftNonZero, pftNonZero);
    });
}

clipper_paths *clipper_offset(const clipper_paths *in, const iso_offset_options *options) {
    return guarded([&](Paths &out) {
        ClipperOffset offset(options->mitre_limit, options->arc_tolerance);
        offset.AddPaths(in->paths, join_type(options->join), etClosedPolygon);
        offset.Execute(out, options->distance);
    });
}

double clipper_area(const clipper_paths *paths) {
    double sum = 0;
    for (const Path &path : paths->paths)
        sum += Area(path);
    return sum;
}

int64_t clipper_points(const clipper_paths *paths) {
    int64_t sum = 0;
    for (const Path &path : paths->paths)
        sum += static_cast<int64_t>(path.size());
    return sum;
}

int32_t clipper_contours(const clipper_paths *paths) {
    return static_cast<int32_t>(paths->paths.size());
}
