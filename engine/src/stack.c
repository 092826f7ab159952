#include "stack.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "config/settings_objects.h"
#include "planar/section.h"
#include "solid/check.h"

enum { LAYERS_PER_THREAD = 8 };

/* ---- the crew ---- */

iso_status crew_new(iso_crew *crew, int32_t threads) {
    ISO_TRY(iso_pool_new(&crew->pool, threads));
    crew->count = iso_pool_threads(crew->pool);
    ISO_TRY(ISO_ALLOCATE(crew->hand, crew->count));
    memset(crew->hand, 0, (size_t)crew->count * sizeof *crew->hand);
    for (int32_t i = 0; i < crew->count; i++)
        ISO_TRY(hand_new(&crew->hand[i]));
    return ISO_OK;
}

void crew_free(iso_crew *crew) {
    for (int32_t i = 0; crew->hand && i < crew->count; i++)
        hand_free(&crew->hand[i]);
    iso_release(crew->hand);
    iso_pool_free(crew->pool);
}

/* ---- slices ---- */

/* Seen from above; of curved layers, from wherever. */
static double projected_area(const iso_mesh *mesh, bool flat) {
    double sum = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        const int32_t *v = mesh->origin + 3 * (int64_t)t;
        iso_vec3 a = mesh->position[v[0]], b = mesh->position[v[1]], c = mesh->position[v[2]];
        iso_vec3 across = vec3_cross(vec3_minus(b, a), vec3_minus(c, a));
        sum += flat ? fabs(across.z) : vec3_length(across);
    }
    return sum / 2;
}

static int64_t slices_bytes(const iso_slices *slices) {
    return slices->crossing_count * (int64_t)sizeof *slices->point +
           slices->contour_count * (int64_t)sizeof *slices->contour_first +
           slices->level_count * (int64_t)sizeof *slices->level_first;
}

static iso_status make_levels(iso_stack *stack, const iso_object *object) {
    const iso_options *options = stack->options;
    double heights[ISO_NUMBERS_MAX + 1];
    if (!curved_is_flat(&stack->curved)) {
        ISO_TRY(curved_levels(&stack->levels, &stack->curved, options));
    } else if (options->adaptive_layers) {
        iso_adaptive_options adaptive = settings_of_adaptive(options);
        ISO_TRY(iso_levels_adaptive(&stack->levels, object->mesh, object->mesh_count, &adaptive));
    } else {
        int32_t count = iso_options_heights(heights, options);
        ISO_TRY(iso_levels_from_heights(&stack->levels, heights, count, object->max.z));
    }
    if (stack->levels.count > 0)
        return ISO_OK;
    return iso_fail(ISO_OUTSIDE, "%s is %.4f mm high: too low for a first layer of %.3f mm",
                    object->name, object->max.z, iso_options_first_height(options));
}

/* Of the mesh's volume, what is above the last flat layer is not printed. */
static iso_status slice_mesh(iso_stack *stack, iso_slices *slices, const iso_mesh *mesh) {
    double height = stack->levels.top[stack->levels.count - 1];
    bool flat = curved_is_flat(&stack->curved);
    stack->mesh_volume += flat ? iso_mesh_volume_between(mesh, 0, height) : iso_mesh_volume(mesh);
    if (flat)
        return iso_slice_planar(slices, mesh, &stack->levels);
    return curved_slice(slices, &stack->curved, mesh, &stack->levels);
}

static iso_status slice_meshes(iso_stack *stack, iso_object *object, bool keep) {
    ISO_TRY(ISO_ALLOCATE(stack->slices, object->mesh_count));
    memset(stack->slices, 0, (size_t)object->mesh_count * sizeof *stack->slices);
    stack->model_count = object->mesh_count;
    for (int32_t i = 0; i < object->mesh_count; i++) {
        iso_mesh *mesh = &object->mesh[i];
        ISO_TRY(slice_mesh(stack, &stack->slices[i], mesh));
        stack->projected += projected_area(mesh, curved_is_flat(&stack->curved));
        stack->slice_bytes += slices_bytes(&stack->slices[i]);
        if (!keep)
            iso_mesh_free(mesh);
    }
    return ISO_OK;
}

/* Meshes go as soon as nothing asks for them any more. */
static iso_status slice_object(iso_stack *stack, iso_object *object) {
    iso_check_solid mode = (iso_check_solid)stack->options->check_solid;
    bool checked = curved_is_flat(&stack->curved) &&
                   solid_check_is_due(object->mesh, object->mesh_count, mode);
    ISO_TRY(slice_meshes(stack, object, checked));
    if (!checked)
        return ISO_OK;
    solid_subject subject = {.name = object->name,
                             .mesh = object->mesh,
                             .slices = stack->slices,
                             .count = object->mesh_count,
                             .levels = &stack->levels,
                             .mode = mode};
    ISO_TRY(solid_check(stack->report, &subject, stack->crew->pool));
    for (int32_t i = 0; i < object->mesh_count; i++)
        iso_mesh_free(&object->mesh[i]);
    return ISO_OK;
}

static iso_status level_volume(double *volume, const iso_stack *stack, int32_t level) {
    *volume = 0;
    for (int32_t m = 0; m < stack->model_count; m++) {
        double more;
        if (curved_is_flat(&stack->curved))
            more = section_area(&stack->slices[m], level) * stack->levels.height[level];
        else
            ISO_TRY(curved_volume(&more, &stack->curved, &stack->slices[m], &stack->levels, level,
                                  &stack->crew->hand[0].arena));
        *volume += more;
    }
    return ISO_OK;
}

/* Slices at the middles of layers miss the volume by less than half a layer under all surface seen
 * from above, and usually by far less. More than that is a wrong slice. */
static iso_status verify_volume(iso_stack *stack, const iso_object *object) {
    const iso_levels *levels = &stack->levels;
    double thickest = 0;
    if (!curved_is_flat(&stack->curved))
        ISO_TRY(ISO_ALLOCATE(stack->level_volume, levels->count));
    for (int32_t i = 0; i < levels->count; i++) {
        double volume;
        ISO_TRY(level_volume(&volume, stack, i));
        if (stack->level_volume)
            stack->level_volume[i] = volume;
        stack->sliced_volume += volume;
        thickest = fmax(thickest, levels->height[i]);
    }
    double allowed = 1e-6 * stack->mesh_volume + stack->projected * thickest / 2;
    if (fabs(stack->sliced_volume - stack->mesh_volume) <= allowed)
        return ISO_OK;
    return iso_fail(ISO_NOT_VERIFIED,
                    "%s: the slices hold %.3f mm^3, the model %.3f mm^3: nothing was written",
                    object->name, stack->sliced_volume, stack->mesh_volume);
}

static const iso_options *options_at(const iso_stack *stack, int32_t k) {
    return stack->modifiers ? modifiers_options(stack->modifiers, k) : stack->options;
}

static int32_t lattices(const iso_stack *stack) {
    return (stack->modifiers ? stack->modifiers->count : 0) + 1;
}

/* The meshes tell how far it is to the skin. */
static iso_status make_lattices(iso_stack *stack, const iso_object *object) {
    bool any = false;
    for (int32_t k = 0; k < lattices(stack); k++)
        any = any || settings_have_lattice(options_at(stack, k));
    if (!any)
        return ISO_OK;
    ISO_TRY(ISO_ALLOCATE(stack->lattice, lattices(stack)));
    memset(stack->lattice, 0, (size_t)lattices(stack) * sizeof *stack->lattice);
    for (int32_t k = 0; k < lattices(stack); k++) {
        char percent[32];
        iso_lattice_options options = settings_of_lattice(options_at(stack, k), percent);
        options.cut = stack->cut;
        if (options.pattern < 0)
            continue;
        ISO_TRY(lattice_new(&stack->lattice[k], &options, object->mesh, object->mesh_count));
        if (lattice_material(stack->lattice[k]))
            stack->tools = 2;
    }
    return ISO_OK;
}

iso_status stack_slice(iso_stack *stack, iso_object *object, const iso_options *options,
                       iso_modifiers *modifiers, const iso_crew *crew) {
    stack->options = modifiers ? modifiers_shell_options(modifiers) : options;
    stack->modifiers = modifiers;
    iso_shell_depth shells = settings_of_shells(stack->options);
    stack->crew = crew;
    stack->tools = 1;
    stack->block = LAYERS_PER_THREAD * crew->count;
    ISO_TRY(curved_new(&stack->curved, stack->report, stack->options, object));
    ISO_TRY(make_levels(stack, object));
    ISO_TRY(make_lattices(stack, object));
    ISO_TRY(slice_object(stack, object));
    ISO_TRY(verify_volume(stack, object));
    if (modifiers)
        ISO_TRY(modifiers_slice(modifiers, &stack->levels, &stack->curved));
    if (combine_is_asked_for(options)) {
        ISO_TRY(ISO_ALLOCATE(stack->combination, stack->levels.count));
        combine_plan(stack->combination, &stack->levels, options);
        stack->around = options->infill_every_layers - 1;
    }
    if (curved_behind(&stack->curved) > stack->around)
        stack->around = curved_behind(&stack->curved);
    return window_new(&stack->window, &stack->levels, &shells, stack->block, stack->around);
}

void stack_free(iso_stack *stack) {
    for (int32_t i = 0; stack->slices && i < stack->model_count; i++)
        iso_slices_free(&stack->slices[i]);
    iso_release(stack->slices);
    iso_release(stack->combination);
    for (int32_t k = 0; stack->lattice && k < lattices(stack); k++)
        lattice_free(stack->lattice[k]);
    iso_release(stack->lattice);
    window_free(&stack->window);
    iso_levels_free(&stack->levels);
    iso_release(stack->level_volume);
    curved_free(&stack->curved);
}

/* ---- layers ---- */

static iso_status outline_task(void *payload, int64_t number, int worker) {
    iso_stack *stack = payload;
    int32_t index = stack->begin + (int32_t)number;
    iso_layer *layer = window_layer(&stack->window, index);
    settings_of_layer(&layer->settings, stack->options, index, stack->levels.height[index]);
    layer->settings.sparse.z = iso_units(stack->levels.cut[index]);
    if (iso_units(stack->levels.top[index] - stack->levels.height[index]) >=
        iso_units(stack->options->lattice_skin)) /* in doubles 0.46 - 0.12 is less than 0.34 */
        layer->settings.drains.count = 0;
    if (stack->combination) {
        const iso_combination *of = &stack->combination[index];
        int32_t turn = of->last / (of->last - of->first + 1);
        settings_of_combination(&layer->settings, stack->options, turn, of->height);
        layer->settings.together.z =
            iso_units((stack->levels.cut[of->first] + stack->levels.cut[of->last]) / 2);
    }
    layer->index = index;
    layer->modifiers = stack->modifiers;
    layer->lattice = (const iso_lattice *const *)stack->lattice;
    if (stack->options->ironing_type == ISO_IRONING_TOPMOST && index + 1 < stack->levels.count)
        layer->settings.irons = 0;
    return layer_outline(layer, &stack->crew->hand[worker], stack->slices, stack->model_count,
                         index);
}

static iso_status widen_task(void *payload, int64_t number, int worker) {
    iso_stack *stack = payload;
    return window_widen(&stack->window, stack->begin + (int32_t)number, stack->level,
                        stack->crew->hand[worker].planar);
}

static iso_status split_task(void *payload, int64_t number, int worker) {
    iso_stack *stack = payload;
    int32_t index = stack->begin + (int32_t)number;
    iso_shell_neighbours around = window_around(&stack->window, index);
    return layer_split(window_layer(&stack->window, index), &stack->crew->hand[worker], &around);
}

static iso_status fill_task(void *payload, int64_t number, int worker) {
    iso_stack *stack = payload;
    int32_t index = stack->begin + (int32_t)number;
    const iso_layer *beneath = index > 0 ? window_layer(&stack->window, index - 1) : NULL;
    iso_hand *hand = &stack->crew->hand[worker];
    if (stack->combination)
        ISO_TRY(combine_layer(&stack->window, index, &stack->combination[index], hand));
    iso_layer *layer = window_layer(&stack->window, index);
    ISO_TRY(layer_fill(layer, hand, beneath));
    return curved_clip(&layer->paths, &hand->paths, &stack->curved, &hand->arena);
}

static int32_t least(int32_t a, int32_t b) {
    return a < b ? a : b;
}

/* Outlines up to `end`, and the runs that lie wholly below it. */
static iso_status outline_up_to(iso_stack *stack, int32_t end) {
    iso_window *window = &stack->window;
    for (stack->level = 0; stack->level < window->levels; stack->level++) {
        int32_t wide = window_wide_end(stack->level, end);
        stack->begin = window->made[stack->level];
        if (wide <= stack->begin)
            break;
        ISO_TRY(iso_parallel_for(stack->crew->pool, wide - stack->begin,
                                 stack->level == 0 ? outline_task : widen_task, stack));
        window->made[stack->level] = wide;
    }
    return ISO_OK;
}

/* Layers up to `end` split into their shells. */
static iso_status split_up_to(iso_stack *stack, int32_t end) {
    iso_window *window = &stack->window;
    ISO_TRY(outline_up_to(stack, least(end + window->top, window->count)));
    stack->begin = window->split;
    ISO_TRY(iso_parallel_for(stack->crew->pool, end - stack->begin, split_task, stack));
    window->split = end;
    return ISO_OK;
}

/* Outlines run ahead by the height of the top shell, and stay until the bottom shell above them is
 * done. */
iso_status stack_layer(iso_layer **layer, iso_stack *stack, int32_t index) {
    if (index == stack->filled) {
        int32_t count = stack->levels.count, end = least(stack->filled + stack->block, count);
        ISO_TRY(split_up_to(stack, least(end + stack->around, count)));
        stack->begin = stack->filled;
        ISO_TRY(iso_parallel_for(stack->crew->pool, end - stack->filled, fill_task, stack));
        stack->filled = end;
    }
    *layer = window_layer(&stack->window, index);
    return ISO_OK;
}

void stack_rewind(iso_stack *stack) {
    stack->filled = stack->window.split = 0;
    memset(stack->window.made, 0, sizeof stack->window.made);
}
