/* triptych.h: the C interface of the Triptych render core. SPDX-License-Identifier: Apache-2.0
 *
 * A scene is filled through ids, committed, and rendered:
 *
 *     TrpScene* scene;                 trp_scene_create(&scene);
 *     TrpMeshDesc mesh;                trp_mesh_desc_init(&mesh, sizeof mesh);  ... fill it ...
 *     uint32_t mesh_id;                trp_mesh_add(scene, &mesh, &mesh_id);
 *     ... instances, materials, lights, a camera ...
 *     trp_scene_commit(scene);
 *     TrpRender* render;               trp_render_create(scene, "ray_casting", &render);
 *     trp_render_set(render, "samples", "16");
 *     trp_render_run(render, NULL);    trp_render_write(render, "picture.exr");
 *
 * Units       metres, radians, linear Rec. 709 colour; radiance W/(m² sr), irradiance W/m², intensity W/sr.
 * Axes        right-handed, Z up. Cameras and lights look down their own −Z, with +Y up, as in Blender.
 * Transforms  3 rows of 4 floats, row-major (world = M · (x, y, z, 1)); one such block for each time sample.
 * Buffers     row 0 of a picture is its bottom row.
 * Errors      every function that can fail returns a TrpStatus. On failure, trp_error_message() gives one line that
 *             names the item and the value; the scene or render is as it was before the call. No call throws, aborts
 *             or exits.
 * Ownership   data that goes in is copied before the call returns. Data that comes out goes into the caller's buffer,
 *             or is a string owned by the library with the lifetime that the function states.
 * Threads     a scene, and a render, may be used by one thread at a time, except where a function says "any thread".
 *             Different scenes and renders are independent. A render reads the snapshot made by the last commit
 *             before trp_render_create, so that its scene may be edited and committed while it runs.
 * Versions    descriptor structs start with struct_size. The init function of each writes the defaults into the
 *             struct_size bytes that the caller has, so that a program built against an older header keeps working.
 *             All enumerations are int32_t with the values written here, which never change. */
/* The columns are laid by hand. */
/* clang-format off */
#ifndef TRIPTYCH_TRIPTYCH_H
#define TRIPTYCH_TRIPTYCH_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#if defined(TRIPTYCH_BUILDING)
#define TRP_API __declspec(dllexport)
#else
#define TRP_API __declspec(dllimport)
#endif
#else
#define TRP_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define TRP_VERSION_MAJOR 0
#define TRP_VERSION_MINOR 1
#define TRP_VERSION_PATCH 0
/* major · 10000 + minor · 100 + patch */
#define TRP_VERSION (TRP_VERSION_MAJOR * 10000 + TRP_VERSION_MINOR * 100 + TRP_VERSION_PATCH)

/* Never the id of anything: "none" where an id is optional. Ids are unique within their scene and never reused. */
#define TRP_NO_ID 0u
/* "No node" in TrpCoefficient and TrpNode. */
#define TRP_NO_NODE (-1)

/* ------------------------------------------------------------------------------------------------ status and version */

typedef int32_t TrpStatus;
enum {
    TRP_OK = 0,
    TRP_ERROR_ARGUMENT = 1,  /* a null pointer, a wrong size, an unknown name, a value out of range, NaN */
    TRP_ERROR_ID = 2,        /* an id that this scene does not have, or has removed */
    TRP_ERROR_STATE = 3,     /* the call does not fit the state: a render of a scene that was never committed */
    TRP_ERROR_MEMORY = 4,    /* memory ran out, or a request is beyond what can be addressed */
    TRP_ERROR_FILE = 5,      /* a file could not be read or written */
    TRP_ERROR_INTERNAL = 6,  /* a fault of the library; please report it */
    TRP_CANCELLED = 7        /* not an error: the render was cancelled, and what it had finished can be read */
};

/* The version of the library that is loaded, as TRP_VERSION is written. Any thread. */
TRP_API uint32_t trp_version(void);

/* One line about the last call of this thread that failed; empty if none has. Valid until the thread's next failure. */
TRP_API const char* trp_error_message(void);

/* ------------------------------------------------------------------------------------------------------------- arrays */

enum {
    TRP_FORMAT_FLOAT32 = 0,
    TRP_FORMAT_UINT8 = 1,
    TRP_FORMAT_UINT16 = 2,
    TRP_FORMAT_UINT32 = 3,
    TRP_FORMAT_INT32 = 4 /* a negative index is out of range */
};

/* An array in the caller's memory, read during the call only. An element may be several numbers (a position is 3):
 * the field that takes the array says how many. A null `data` with a count of 0 means "not given". */
typedef struct TrpArray {
    const void* data;
    uint64_t count;  /* elements */
    uint32_t stride; /* bytes from one element to the next; 0: packed */
    int32_t format;  /* TRP_FORMAT_… of each number */
} TrpArray;

enum {
    TRP_DOMAIN_VERTEX = 0, /* one element to a vertex */
    TRP_DOMAIN_CORNER = 1  /* one element to a face corner, in the order of corner_vertices */
};

/* A named layer of a mesh: texture coordinates (2 numbers, v up) or colour (3 or 4 numbers, linear Rec. 709; the
 * fourth is alpha). FLOAT32 only. */
typedef struct TrpAttribute {
    const char* name;
    TrpArray values;
    int32_t domain;     /* TRP_DOMAIN_… */
    int32_t components; /* numbers to an element */
} TrpAttribute;

/* -------------------------------------------------------------------------------------------------------------- scene */

typedef struct TrpScene TrpScene;

/* Makes an empty scene. The caller destroys it. Renders keep what they need of it, so it may go before them. */
TRP_API TrpStatus trp_scene_create(TrpScene** scene);
/* Destroys the scene; null is allowed. */
TRP_API void trp_scene_destroy(TrpScene* scene);

/* Makes the snapshot that later renders see: checks references between items, triangulates new faces, and builds what
 * rays need. Its cost follows what changed since the last commit. Where it fails, the last snapshot stays.
 * `threads`: 0 uses every core. */
TRP_API TrpStatus trp_scene_commit(TrpScene* scene, uint32_t threads);

typedef struct TrpSceneInfo {
    uint32_t struct_size;
    uint32_t mesh_count, instance_count, material_count, texture_count, light_count, camera_count;
    uint64_t face_count, triangle_count, vertex_count; /* over all instances, as the last commit saw them */
    float bounds_min[3], bounds_max[3];                /* of all instances, world space; min > max where there is none */
    uint64_t mesh_bytes; /* size of the mesh data as it was handed in (packed) */
    uint64_t held_bytes; /* what the core holds for it, without the ray acceleration structure */
    uint64_t bvh_bytes;  /* the ray acceleration structure */
    double commit_seconds, bvh_seconds; /* wall time of the last commit, and of its part in the ray library */
} TrpSceneInfo;
/* What the last commit saw. */
TRP_API TrpStatus trp_scene_info(const TrpScene* scene, TrpSceneInfo* info);

enum {
    TRP_WARNING_MESH = 1,     /* faces or values that were left out */
    TRP_WARNING_MATERIAL = 2, /* a reference to a material that is not there: a default grey stands in */
    TRP_WARNING_TEXTURE = 3,  /* a picture that could not be read: magenta stands in */
    TRP_WARNING_CAMERA = 4,
    TRP_WARNING_LIGHT = 5
};
typedef struct TrpWarning {
    uint32_t struct_size;
    int32_t code;     /* TRP_WARNING_… */
    uint32_t item;    /* the id of the mesh, instance, material, texture, light or camera meant; TRP_NO_ID: the scene */
    const char* text; /* one line; valid until the next commit or the scene's end */
} TrpWarning;
/* Warnings of the last commit: trp_scene_warning gives number `index` of them, from 0. */
TRP_API uint32_t trp_scene_warning_count(const TrpScene* scene);
TRP_API TrpStatus trp_scene_warning(const TrpScene* scene, uint32_t index, TrpWarning* warning);

/* ------------------------------------------------------------------------------------------------------------- meshes */

enum {                     /* bits of edge_flags */
    TRP_EDGE_SHARP = 1,    /* averaged normals do not cross it */
    TRP_EDGE_MARKED = 2    /* drawn as a feature line (Freestyle mark) */
};

/* A mesh of n-gons, as modelling programs keep it. Faces are runs of corners; a corner names a vertex.
 * Faces that have fewer than three different vertices, or no area, are left out with a warning. */
typedef struct TrpMeshDesc {
    uint32_t struct_size;
    uint32_t time_count;      /* time samples of the positions, evenly spaced over the shutter, 1 to 129; default 1.
                                 Methods that trace rays blur motion between them, the rasterizer shows the first.
                                 Normals are of the first, and follow the faces */
    const char* name;         /* UTF-8, for messages; may be null */
    TrpArray positions;       /* FLOAT32 × 3; count = vertices · time_count, sample after sample */
    TrpArray face_offsets;    /* indices; faces + 1 ascending corner offsets from 0; not given: all faces are triangles */
    TrpArray corner_vertices; /* indices; the vertex of each corner */
    TrpArray normals;         /* FLOAT32 × 3, object space, optional: the mesh's own (split) normals */
    int32_t normal_domain;    /* TRP_DOMAIN_… of normals */
    uint32_t uv_set_count;
    const TrpAttribute* uv_sets;        /* the first is the one used where a texture names none */
    const TrpAttribute* colors;         /* vertex colours */
    uint32_t color_count;
    uint32_t material_count;
    const uint32_t* materials;          /* material ids by slot; TRP_NO_ID: the default grey */
    TrpArray face_materials;            /* indices; the slot of each face; not given: slot 0 */
    TrpArray face_smooth;               /* UINT8; 1: the face is smooth; not given: faces are flat unless normals are given */
    TrpArray edges;                     /* index pairs (2 numbers an element), loose edges too; not given: the faces' sides */
    TrpArray edge_flags;                /* UINT8; TRP_EDGE_… bits, one for each of edges */
    TrpArray edge_creases;              /* FLOAT32, 0 to 1, one for each of edges: subdivision sharpness */
    TrpArray vertex_creases;            /* FLOAT32, 0 to 1, one for each vertex */
} TrpMeshDesc;
TRP_API TrpStatus trp_mesh_desc_init(TrpMeshDesc* desc, size_t struct_size);
TRP_API TrpStatus trp_mesh_add(TrpScene* scene, const TrpMeshDesc* desc, uint32_t* id);
/* Exchanges the whole mesh; its instances stay. */
TRP_API TrpStatus trp_mesh_replace(TrpScene* scene, uint32_t id, const TrpMeshDesc* desc);
/* Instances of a mesh that was removed are an error of the next commit. */
TRP_API TrpStatus trp_mesh_remove(TrpScene* scene, uint32_t id);

typedef struct TrpInstanceDesc {
    uint32_t struct_size;
    uint32_t mesh;                  /* the id of the mesh shown */
    const char* name;
    const float* world_from_object; /* 12 · time_count floats; null: identity */
    uint32_t time_count;            /* 1 to 129, default 1 */
    uint32_t material_count;
    const uint32_t* materials;      /* material ids by slot, in place of the mesh's; TRP_NO_ID keeps the mesh's */
    float color[3];                 /* the object's colour, for nodes and lines that ask for it; default 1 */
    int32_t index;                  /* the number in the object index pass; default 0 */
    int32_t visible_camera;         /* seen by primary rays; default 1 */
    int32_t visible_shadow;         /* casts shadows; default 1 */
} TrpInstanceDesc;
TRP_API TrpStatus trp_instance_desc_init(TrpInstanceDesc* desc, size_t struct_size);
TRP_API TrpStatus trp_instance_add(TrpScene* scene, const TrpInstanceDesc* desc, uint32_t* id);
TRP_API TrpStatus trp_instance_replace(TrpScene* scene, uint32_t id, const TrpInstanceDesc* desc);
/* Changes the transform alone: 12 · time_count floats. */
TRP_API TrpStatus trp_instance_move(TrpScene* scene, uint32_t id, const float* world_from_object, uint32_t time_count);
TRP_API TrpStatus trp_instance_remove(TrpScene* scene, uint32_t id);

/* --------------------------------------------------------------------------------------------- textures and materials */

enum {
    TRP_COLOR_SPACE_AUTO = 0,   /* as the file says: 8-bit files are sRGB, floating-point files linear */
    TRP_COLOR_SPACE_SRGB = 1,
    TRP_COLOR_SPACE_LINEAR = 2  /* numbers, not colours: normal maps, roughness */
};
enum { TRP_WRAP_REPEAT = 0, TRP_WRAP_CLAMP = 1, TRP_WRAP_MIRROR = 2, TRP_WRAP_BLACK = 3 };
enum { TRP_FILTER_SMOOTH = 0, TRP_FILTER_NEAREST = 1 };

/* A picture, from one of three sources: a path; an image file's bytes; or pixels. */
typedef struct TrpTextureDesc {
    uint32_t struct_size;
    int32_t color_space;        /* TRP_COLOR_SPACE_… */
    const char* name;           /* for messages */
    const char* path;           /* UTF-8; the file is read when it is first needed, and must not change until then */
    const void* file_data;      /* or: the bytes of a PNG, JPEG, EXR, … file */
    uint64_t file_size;
    const float* pixels;        /* or: width · height · channels floats, row 0 at the bottom */
    uint32_t width, height, channels; /* of pixels; channels 1 to 4 */
    int32_t wrap_u, wrap_v;     /* TRP_WRAP_… */
    int32_t filter;             /* TRP_FILTER_… */
} TrpTextureDesc;
TRP_API TrpStatus trp_texture_desc_init(TrpTextureDesc* desc, size_t struct_size);
TRP_API TrpStatus trp_texture_add(TrpScene* scene, const TrpTextureDesc* desc, uint32_t* id);
TRP_API TrpStatus trp_texture_replace(TrpScene* scene, uint32_t id, const TrpTextureDesc* desc);
TRP_API TrpStatus trp_texture_remove(TrpScene* scene, uint32_t id);

/* A material is a list of nodes in order of evaluation: a node reads only nodes before it. Each node gives a value of
 * four numbers (r, g, b, a); what a node reads is named in trp_node_info's table. */
enum {
    TRP_NODE_CONSTANT = 0,     /* value */
    TRP_NODE_UV = 1,           /* (u, v, 0, 0) of the UV set `name`; empty or null: the first; a mesh without it: 0 */
    TRP_NODE_COLOR = 2,        /* the vertex colour layer `name`; empty or null: the first; a mesh without it: 1 */
    TRP_NODE_OBJECT_COLOR = 3, /* the instance's colour */
    TRP_NODE_IMAGE = 4,        /* texture `texture` at inputs[0] (none: the first UV set), linear, filtered by footprint */
    TRP_NODE_NORMAL_MAP = 5,   /* inputs[0]: the map's rgb; value[0]: strength; name: its UV set. A tangent-space normal
                                  (OpenGL's convention, +Y up), turned into a world-space normal */
    TRP_NODE_UV_TRANSFORM = 6, /* inputs[0]: uv; value: (scale_u, scale_v, offset_u, offset_v), value2[0]: rotation in
                                  radians, as KHR_texture_transform: scaled, then turned, then moved */
    TRP_NODE_CHANNEL = 7,      /* channel value[0] (0 to 3) of inputs[0], in r, g and b; alpha 1 */
    TRP_NODE_ADD = 8,          /* inputs[0] + inputs[1], number by number; an input of none reads value, value2 */
    TRP_NODE_SUBTRACT = 9,
    TRP_NODE_MULTIPLY = 10,
    TRP_NODE_DIVIDE = 11,      /* 0 where the divisor is 0 */
    TRP_NODE_POWER = 12,       /* of max(inputs[0], 0) */
    TRP_NODE_MIX = 13,         /* inputs[0] + (inputs[1] − inputs[0]) · inputs[2] */
    TRP_NODE_CLAMP = 14,       /* inputs[0] held between 0 and 1 */
    TRP_NODE_GREATER = 15      /* 1 where inputs[0] > inputs[1], else 0 */
};
#define TRP_NODE_INPUTS 3
typedef struct TrpNode {
    int32_t type;                    /* TRP_NODE_… */
    int32_t inputs[TRP_NODE_INPUTS]; /* indices of earlier nodes, or TRP_NO_NODE: input k reads value, value2, value3 */
    float value[4], value2[4], value3[4];
    uint32_t texture;                /* IMAGE */
    const char* name;                /* UV, COLOR, NORMAL_MAP */
} TrpNode;
/* Writes a node of that type with no inputs, values 0, strength and scale 1. */
TRP_API TrpStatus trp_node_init(TrpNode* node, int32_t type);

typedef struct TrpNodeInfo {
    uint32_t struct_size;
    int32_t type;
    const char* name;        /* "image", the word used in extras.triptych of a glTF file */
    const char* description;
    uint32_t input_count;
} TrpNodeInfo;
/* The table of node types, index from 0. Strings live as long as the library. Any thread. */
TRP_API uint32_t trp_node_count(void);
TRP_API TrpStatus trp_node_info(uint32_t index, TrpNodeInfo* info);

/* A coefficient of the equation: value · node, or value alone where node is TRP_NO_NODE. A scalar uses value[0] and the
 * node's r. */
typedef struct TrpCoefficient {
    float value[3];
    int32_t node;
} TrpCoefficient;

/* I = I_E + K_A I_A + Σ_L (K_D (N·L) + K_S (V·R)^n) S_L I_L + K_S I_R + K_T I_T */
typedef struct TrpMaterialDesc {
    uint32_t struct_size;
    uint32_t node_count;
    const TrpNode* nodes;
    const char* name;
    TrpCoefficient emission;     /* I_E, radiance in W/(m² sr); default 0 */
    TrpCoefficient ambient;      /* K_A; default: as diffuse (see ambient_is_diffuse) */
    TrpCoefficient diffuse;      /* K_D, the diffuse reflectance; default 0.8 */
    TrpCoefficient specular;     /* K_S; default 0 */
    TrpCoefficient shininess;    /* n, Phong's exponent, ≥ 0; scalar; default 30 */
    TrpCoefficient mirror;       /* the weight of I_R; default: as specular (see mirror_is_specular) */
    TrpCoefficient transmission; /* K_T, the weight of I_T, which goes to I_R where light is totally reflected; default 0 */
    TrpCoefficient ior;          /* η, scalar, > 0; default 1.5 */
    TrpCoefficient alpha;        /* coverage: 0 invisible, 1 opaque; scalar; default 1 */
    int32_t normal;              /* a node that gives a world-space normal (NORMAL_MAP), or TRP_NO_NODE */
    int32_t ambient_is_diffuse;  /* K_A = K_D; default 1 */
    int32_t mirror_is_specular;  /* I_R is weighed by K_S; default 1 */
    int32_t thin;                /* transmitted rays go straight on; default 0 */
    int32_t double_sided;        /* 0: the eye sees through its back, which to all light is black and stands there; default 1 */
    int32_t index;               /* the number in the material index pass; default 0 */
    int32_t fresnel;             /* 1: I_R is also weighed by Fresnel's reflectance R of η, I_T by 1 − R; default 0 */
    int32_t priority;            /* of solids that lie in each other: the greater one fills the space; default 0 */
    float absorption[3];         /* of solids: light fades as exp(−absorption · distance), 1/m; default 0 */
} TrpMaterialDesc;
TRP_API TrpStatus trp_material_desc_init(TrpMaterialDesc* desc, size_t struct_size);
TRP_API TrpStatus trp_material_add(TrpScene* scene, const TrpMaterialDesc* desc, uint32_t* id);
TRP_API TrpStatus trp_material_replace(TrpScene* scene, uint32_t id, const TrpMaterialDesc* desc);
TRP_API TrpStatus trp_material_remove(TrpScene* scene, uint32_t id);

/* ------------------------------------------------------------------------------------------- lights, world and cameras */

enum {
    TRP_LIGHT_POINT = 0,
    TRP_LIGHT_SPOT = 1,
    TRP_LIGHT_SUN = 2,
    TRP_LIGHT_AREA = 3 /* emits to −Z */
};
enum { TRP_SHAPE_RECTANGLE = 0, TRP_SHAPE_ELLIPSE = 1 /* a disk where size[0] = size[1] */ };
enum {
    TRP_FALLOFF_PHYSICAL = 0, /* 1/d² */
    TRP_FALLOFF_LINEAR = 1,   /* 1/d: as physical at one metre */
    TRP_FALLOFF_CONSTANT = 2  /* the same at every distance: as physical at one metre */
};
typedef struct TrpLightDesc {
    uint32_t struct_size;
    int32_t type;                  /* TRP_LIGHT_… */
    const char* name;
    const float* world_from_light; /* 12 · time_count floats; null: identity. Scale multiplies an area light's size only */
    uint32_t time_count;
    int32_t falloff;               /* TRP_FALLOFF_…; not for the sun */
    float emission[3];             /* point, spot: intensity, W/sr. Sun: irradiance facing it, W/m². Area: radiance,
                                      W/(m² sr), before the spread narrows it. Default 1 */
    float radius;                  /* point, spot: of the disk, facing the lit point, that emits; 0: a point. Default 0 */
    float angle;                   /* sun: its angular diameter; spot: the full cone angle; area: the spread, π is
                                      all. Default: 0, π/4, π by type; a negative value stands for the default */
    float blend;                   /* spot: the share of the cone in which its edge fades, 0 to 1; default 0.15 */
    float size[2];                 /* area: full width and height, metres; default 1. Of the scale, the first sample counts */
    int32_t shape;                 /* area: TRP_SHAPE_… */
    int32_t cast_shadow;           /* default 1 */
    int32_t visible_camera;        /* area: seen by primary rays; default 0 */
    uint32_t group;                /* light group: 1 to 8 have a pass, LightGroup1 and so on; 0 is none */
} TrpLightDesc;
TRP_API TrpStatus trp_light_desc_init(TrpLightDesc* desc, size_t struct_size);
TRP_API TrpStatus trp_light_add(TrpScene* scene, const TrpLightDesc* desc, uint32_t* id);
TRP_API TrpStatus trp_light_replace(TrpScene* scene, uint32_t id, const TrpLightDesc* desc);
TRP_API TrpStatus trp_light_remove(TrpScene* scene, uint32_t id);

/* The background, which lights the scene too. */
typedef struct TrpWorldDesc {
    uint32_t struct_size;
    uint32_t texture;             /* latitude-longitude picture, or TRP_NO_ID */
    float radiance[3];            /* constant, or the factor on the texture; default 0 */
    const float* world_from_texture; /* 12 floats, a rotation; null: identity, where direction (x, y, z) reads
                                     u = 1/2 − atan2(y, x)/2π, v = 1/2 + asin(z)/π, as in Blender */
    int32_t visible_camera;       /* seen where rays hit nothing; default 1 */
    int32_t light;                /* sampled as a light; default 1 */
} TrpWorldDesc;
TRP_API TrpStatus trp_world_desc_init(TrpWorldDesc* desc, size_t struct_size);
TRP_API TrpStatus trp_scene_set_world(TrpScene* scene, const TrpWorldDesc* desc);

enum { TRP_CAMERA_PERSPECTIVE = 0, TRP_CAMERA_ORTHOGRAPHIC = 1 };
enum {
    TRP_FIT_AUTO = 0,       /* field_of_view and width span the film's longer side */
    TRP_FIT_HORIZONTAL = 1,
    TRP_FIT_VERTICAL = 2
};
typedef struct TrpCameraDesc {
    uint32_t struct_size;
    int32_t type;                   /* TRP_CAMERA_… */
    const char* name;
    const float* world_from_camera; /* 12 · time_count floats, scale ignored; null: identity */
    uint32_t time_count;
    int32_t fit;                    /* TRP_FIT_… */
    float field_of_view;            /* perspective: full angle across the fitted side; default 0.69 */
    float width;                    /* orthographic: metres across the fitted side, at most 1e9; default 6 */
    float shift[2];                 /* of the picture, in fitted sides; default 0 */
    float clip_start, clip_end;     /* along −Z; defaults 0.01 and 1000 */
    float aperture_radius;          /* of the lens, at most 1e6 m; 0: a pinhole. Default 0 */
    float focus_distance;           /* along −Z, > 0; default 10 */
    uint32_t blade_count;           /* 0 to 2: a round aperture; else a polygon */
    float blade_rotation;           /* radians */
    float shutter[2];               /* opening and closing within the time samples, 0 to 1; default 0, 1 */
    float pixel_aspect;             /* a pixel's width over its height; default 1 */
} TrpCameraDesc;
TRP_API TrpStatus trp_camera_desc_init(TrpCameraDesc* desc, size_t struct_size);
TRP_API TrpStatus trp_camera_add(TrpScene* scene, const TrpCameraDesc* desc, uint32_t* id);
TRP_API TrpStatus trp_camera_replace(TrpScene* scene, uint32_t id, const TrpCameraDesc* desc);
TRP_API TrpStatus trp_camera_remove(TrpScene* scene, uint32_t id);
/* The camera that renders use; TRP_NO_ID: none. */
TRP_API TrpStatus trp_scene_set_camera(TrpScene* scene, uint32_t id);

/* --------------------------------------------------------------------------------- methods, settings and passes: tables */
/* Index from 0; strings live as long as the library. Any thread. */

typedef struct TrpMethodInfo {
    uint32_t struct_size;
    const char* name;        /* "ray_casting" */
    const char* label;       /* "Ray Casting" */
    const char* description; /* a sentence */
} TrpMethodInfo;
TRP_API uint32_t trp_method_count(void);
TRP_API TrpStatus trp_method_info(uint32_t index, TrpMethodInfo* info);

enum { TRP_TYPE_BOOL = 0, TRP_TYPE_INT = 1, TRP_TYPE_FLOAT = 2, TRP_TYPE_COLOR = 3, TRP_TYPE_ENUM = 4 };
typedef struct TrpSettingInfo {
    uint32_t struct_size;
    int32_t type;               /* TRP_TYPE_… */
    const char* name;           /* "shading.specular" */
    const char* label;          /* "Specular" */
    const char* description;
    const char* unit;           /* "pixels", "radians", … or empty */
    const char* default_value;  /* as trp_render_set takes it */
    double minimum, maximum;    /* INT, FLOAT, COLOR */
    const char* const* choices; /* ENUM: null-terminated */
    const char* methods;        /* names of the methods that use it, with a space between; "*": all */
    const char* method_defaults; /* "METHOD=VALUE" with a space between, where they are not default_value; or empty */
} TrpSettingInfo;
TRP_API uint32_t trp_setting_count(void);
TRP_API TrpStatus trp_setting_info(uint32_t index, TrpSettingInfo* info);

typedef struct TrpPassInfo {
    uint32_t struct_size;
    uint32_t channel_count; /* 1 to 4 */
    const char* name;       /* "Normal" */
    const char* channels;   /* "XYZ", a letter to a channel */
    const char* description;
    const char* methods;    /* as in TrpSettingInfo */
} TrpPassInfo;
TRP_API uint32_t trp_pass_count(void);
TRP_API TrpStatus trp_pass_info(uint32_t index, TrpPassInfo* info);

/* ------------------------------------------------------------------------------------------------------------ renders */

typedef struct TrpRender TrpRender;

/* Makes a render of the scene's last commit by a method of the table. The caller destroys it. */
TRP_API TrpStatus trp_render_create(TrpScene* scene, const char* method, TrpRender** render);
/* Destroys the render, which must not be running; null is allowed. */
TRP_API void trp_render_destroy(TrpRender* render);

/* The picture's size in pixels (default 960 × 540) and the window of it that is rendered, from the bottom left.
 * A window of 0 × 0 is the whole picture. */
TRP_API TrpStatus trp_render_set_film(TrpRender* render, uint32_t width, uint32_t height, uint32_t window_x,
                                      uint32_t window_y, uint32_t window_width, uint32_t window_height);
/* Sets a setting of the table from text: "16", "0.5", "on", "phong", "0.1,0.1,0.2". */
TRP_API TrpStatus trp_render_set(TrpRender* render, const char* name, const char* value);
/* Asks for a pass of the table. Combined is always there. TRP_ERROR_ARGUMENT for one that the method does not have. */
TRP_API TrpStatus trp_render_add_pass(TrpRender* render, const char* name);

typedef struct TrpProgress {
    uint32_t struct_size;
    double fraction;          /* of the work, 0 to 1 */
    double seconds;           /* since the start */
    double seconds_left;      /* an estimate; negative while unknown */
    uint32_t pass, pass_count; /* passes over the film, from 0; of radiosity, steps that are done and asked for */
    const char* stage;        /* "Rendering"; valid during the call */
} TrpProgress;
typedef struct TrpTile {
    uint32_t struct_size;
    uint32_t x, y, width, height; /* in pixels of the picture, from the bottom left */
    uint32_t pass;
} TrpTile;
/* Called on the thread that called trp_render_run, and only while it runs. A return value of 0 cancels. In `tile`,
 * trp_render_read may read the tile. Any of them may be null. */
typedef struct TrpCallbacks {
    uint32_t struct_size;
    void* user;
    int32_t (*progress)(void* user, const TrpProgress* progress);
    int32_t (*tile)(void* user, const TrpTile* tile);
    void (*log)(void* user, const char* text);
} TrpCallbacks;
TRP_API TrpStatus trp_callbacks_init(TrpCallbacks* callbacks, size_t struct_size);

/* Renders, and returns when the picture is whole, cancelled (TRP_CANCELLED) or failed. May be called again.
 * `callbacks` may be null. */
TRP_API TrpStatus trp_render_run(TrpRender* render, const TrpCallbacks* callbacks);
/* Makes a running trp_render_run return within 100 ms; without effect where none runs. Any thread,
 * but not a signal handler. */
TRP_API TrpStatus trp_render_cancel(TrpRender* render);

/* Copies a rectangle of a pass into the caller's buffer: width · height · channels floats, packed, row 0 at the bottom.
 * x and y are pixels of the picture. `float_count` is the size of the buffer in floats, which must be exact. Pixels that
 * no sample has reached are 0. */
TRP_API TrpStatus trp_render_read(const TrpRender* render, const char* pass, uint32_t x, uint32_t y, uint32_t width,
                                  uint32_t height, float* buffer, size_t float_count);
/* Writes the passes into a file, which appears whole or not at all: .exr, all passes, float, channels named
 * ViewLayer.Pass.C as Blender and Nuke do, data window = the render's window; or .png, Combined, 8-bit sRGB. */
TRP_API TrpStatus trp_render_write(const TrpRender* render, const char* path);

/* Where points of the world lie in the picture that the camera gives: `positions` has 3 numbers to a point; `film`
 * becomes 3: x and y in pixels from the bottom left, and the depth before the camera in metres, negative behind it,
 * where x and y mean nothing. The render need not have run, but must not be running. */
TRP_API TrpStatus trp_render_project(const TrpRender* render, const float* positions, size_t count, float* film);

#define TRP_NO_VERTEX 0xFFFFFFFFu
/* How scan-line interpolation (raster.interpolation = scan_line) makes the value of a pixel's centre: down the sides of
 * the polygon that is seen there, A = alpha I1 + (1 - alpha) I2 and B = beta I3 + (1 - beta) I4, and across the scan
 * line, I = (1 - gamma) A + gamma B. The values are radiance in W/(m^2 sr) where the render's method is gouraud, and
 * unit normals in world space, on the side that is seen, where it is phong (I is not of unit length then). */
typedef struct TrpScanLine {
    uint32_t struct_size;
    int32_t seen;         /* 0: no surface is seen there, and all that follows is 0 */
    uint32_t instance;    /* the id of the object */
    uint32_t face;        /* of its mesh */
    const char* mesh;     /* its name, or ""; the render's, until it is destroyed */
    uint32_t vertices[4]; /* of I1 to I4: the upper and the lower end of the side on the left, and of that on the right;
                             TRP_NO_VERTEX where the near plane cuts the side */
    float values[4][3];   /* I1 to I4 */
    float alpha, beta, gamma;
    float a[3], b[3], value[3]; /* A, B and I */
} TrpScanLine;
/* x and y are a pixel of the picture, from the bottom left; the settings are those of the render, which need not have
 * run, but must not be running. TRP_ERROR_STATE for other methods than gouraud and phong. */
TRP_API TrpStatus trp_render_pick_scan_line(const TrpRender* render, uint32_t x, uint32_t y, TrpScanLine* scan_line);

enum { TRP_RAY_PRIMARY = 0, TRP_RAY_REFLECTION = 1, TRP_RAY_TRANSMISSION = 2 };
enum {
    TRP_END_SURFACE = 0,
    TRP_END_LIGHT = 1,      /* an area light */
    TRP_END_BACKGROUND = 2, /* the world */
    TRP_END_DEPTH = 3,      /* not traced, as the settings limit the depth of the tree */
    TRP_END_WEIGHT = 4      /* not traced, as it counts for less than trace.least_weight */
};
#define TRP_NO_PARENT 0xFFFFFFFFu
/* A ray of a pixel's tree. intensity = local + the sum of its children's weight times intensity. World space. */
typedef struct TrpRay {
    uint32_t struct_size;
    int32_t kind, end;     /* TRP_RAY_…, TRP_END_… */
    uint32_t parent;       /* its place in the list, before this one; TRP_NO_PARENT: the primary ray */
    const char* object;    /* name of the mesh where it ends at a surface, else ""; both are the render's, until it is */
    const char* material;  /* destroyed */
    uint32_t instance;     /* id of the object, or TRP_NO_ID */
    float origin[3], direction[3], distance;
    float position[3], normal[3];            /* where it ends at a surface: the shading normal on the side that is seen */
    float local[3], weight[3], intensity[3]; /* W/(m² sr); weight: what its parent gives it, with what absorbs it */
} TrpRay;
/* Traces the tree of the ray through the centre of a pixel, from the bottom left, with the render's settings; the render
 * need not have run, but must not be running. `count` becomes the number of its rays, parents before their children.
 * TRP_ERROR_STATE for other methods than ray_tracing. */
TRP_API TrpStatus trp_render_trace_tree(TrpRender* render, uint32_t x, uint32_t y, uint32_t* count);
/* A ray of the last tree. */
TRP_API TrpStatus trp_render_ray(const TrpRender* render, uint32_t index, TrpRay* ray);

typedef struct TrpStatistics {
    uint32_t struct_size;
    uint32_t threads;
    double solve_seconds, render_seconds;
    uint64_t primary_rays, shadow_rays, reflection_rays, transmission_rays, gather_rays;
    uint64_t triangles;
    /* Thread seconds within render_seconds, by stage; the rest is sampling, bookkeeping and film. */
    double primary_seconds, shadow_seconds, shading_seconds;
    uint64_t peak_memory_bytes; /* of the process */
    /* Of the radiosity solution that the run found, within solve_seconds; see TrpRadiosityInfo. */
    uint64_t elements, links;
    uint32_t iterations;
    double residual;
} TrpStatistics;
/* Of the last trp_render_run. */
TRP_API TrpStatus trp_render_statistics(const TrpRender* render, TrpStatistics* statistics);

/* ---------------------------------------------------------------------------------------------------------- radiosity */

/* A radiosity solution: B = E + rho H, radiosity and irradiance in W/m², on elements that the scene's faces are cut
 * into. It is advanced step by step, read at any time between, and shown by renders of the method "radiosity". */
typedef struct TrpRadiosity TrpRadiosity;

/* A solution of the scene's last commit, with nothing done yet. The caller destroys it. */
TRP_API TrpStatus trp_radiosity_create(TrpScene* scene, TrpRadiosity** radiosity);
/* Destroys it, which must not be running; null is allowed. Renders that show it keep what they need. */
TRP_API void trp_radiosity_destroy(TrpRadiosity* radiosity);
/* Sets a setting of the table, as trp_render_set. TRP_ERROR_STATE once the elements are made. */
TRP_API TrpStatus trp_radiosity_set(TrpRadiosity* radiosity, const char* name, const char* value);

/* Makes the elements, without solving: for form factors, and to look at them. */
TRP_API TrpStatus trp_radiosity_prepare(TrpRadiosity* radiosity, const TrpCallbacks* callbacks);
/* Advances by so many steps, or until it is solved: a step is a shot of the progressive solver, a sweep over the matrix,
 * or a refinement of the hierarchy. TRP_CANCELLED leaves what was done by then. `callbacks` may be null; `tile` is not
 * called. */
TRP_API TrpStatus trp_radiosity_step(TrpRadiosity* radiosity, uint32_t count, const TrpCallbacks* callbacks);
/* Steps until it is solved, or radiosity.iterations steps are done. */
TRP_API TrpStatus trp_radiosity_solve(TrpRadiosity* radiosity, const TrpCallbacks* callbacks);
/* Makes a running call return soon. Any thread, but not a signal handler. */
TRP_API TrpStatus trp_radiosity_cancel(TrpRadiosity* radiosity);

enum {
    TRP_LIMIT_NONE = 0,
    TRP_LIMIT_LINKS = 1, /* there are as many links and elements as it makes */
    TRP_LIMIT_SIZE = 2   /* no element may be divided further */
};
typedef struct TrpRadiosityInfo {
    uint32_t struct_size;
    uint32_t element_count, vertex_count; /* vertices: where elements meet; 0 until the elements are made */
    uint32_t corner_count;                /* of all elements' polygons, as trp_radiosity_polygons gives them */
    uint32_t iterations;                  /* steps done */
    int32_t solved;                       /* there is nothing left to be done; see limited */
    uint64_t links, rays;
    double residual;   /* matrix: the greatest change of the last sweep over the greatest radiosity; progressive: the
                          share of the power that is unshot; hierarchical: the estimated error, W/m² */
    double area;       /* of all elements, m² */
    double power[3];   /* that leaves them, W */
    double unshot[3];  /* of the progressive solver, W */
    double seconds;    /* wall time so far */
    uint32_t projection_side; /* pixels along a side of what trp_radiosity_projection gives */
    int32_t limited;   /* TRP_LIMIT_…: why the hierarchical solver ended before the tolerance; 0: it did not */
} TrpRadiosityInfo;
TRP_API TrpStatus trp_radiosity_info(TrpRadiosity* radiosity, TrpRadiosityInfo* info);
/* Warnings of its making, a reflectance of 1 and above or a scene without surfaces, and of its end: a limit that was met
 * before the tolerance. Strings as in trp_scene_warning. */
TRP_API uint32_t trp_radiosity_warning_count(const TrpRadiosity* radiosity);
TRP_API TrpStatus trp_radiosity_warning(const TrpRadiosity* radiosity, uint32_t index, TrpWarning* warning);

/* Values of all elements, packed, mesh by mesh and face by face where the solver divides none; `float_count` is the size
 * of the buffer in floats, which must be exact.
 *   radiosity, irradiance, emission, unshot   3: W/m²; emission is that of surfaces, without the lamps' light
 *   reflectance                               3
 *   centre, normal                            3: world space
 *   area                                      1: m²
 *   instance, face                            1: the id of the object, and the face of its mesh
 *   row_sum                                   1: of the solver's form factors, 1 where no light can leave the scene; of
 *                                             the matrix and the hierarchical solver, after their first step
 * and of all vertices: vertex_position, vertex_normal (world space), vertex_radiosity, vertex_irradiance, 3 each. */
TRP_API TrpStatus trp_radiosity_read(TrpRadiosity* radiosity, const char* values, float* buffer, size_t float_count);
/* The elements' polygons: element_count + 1 offsets into corner_count vertices, counter-clockwise about the normal. The
 * corners of smaller neighbours are among them, so that a mesh of them has no cracks. */
TRP_API TrpStatus trp_radiosity_polygons(TrpRadiosity* radiosity, uint32_t* offsets, size_t offset_count,
                                         uint32_t* vertices, size_t vertex_count);
/* Row `element` of the form factors by radiosity.form_factors: the share of what leaves the element that arrives at each
 * other; `count` is the number of elements. Of colours that are tinted on the way, their mean. Needs elements. */
TRP_API TrpStatus trp_radiosity_form_factors(TrpRadiosity* radiosity, uint32_t element, double* buffer, size_t count);

/* What an element sees from its middle, as pixels of a square, projection_side² of them. Where radiosity.form_factors is
 * "hemicube": its five faces unfolded into a cross, the top in the middle; else Nusselt's analog: all that is seen, on
 * the unit hemisphere and from there straight down on its base circle, of whose area an element covers its form factor.
 * Looked at from outside, down on the element. `seen`: the element in each pixel, through glass the one that counts for
 * most; or TRP_NO_ELEMENT. `shares`: what each pixel is of the form factors; 0 outside the projection. */
TRP_API TrpStatus trp_radiosity_projection(TrpRadiosity* radiosity, uint32_t element, uint32_t* seen, float* shares,
                                           size_t count);
/* Draws that into a picture: elements by their reflectance, each in a shade of its own. `path` ends in .png or .exr,
 * which has the two arrays as passes, too: Element (-1: none) and FormFactor. */
TRP_API TrpStatus trp_radiosity_write_projection(TrpRadiosity* radiosity, uint32_t element, const char* path);
/* The outline of element `seen`, itself projected to the unit hemisphere about the middle of `element` and cut at its
 * horizon: up to `corner_count` unit vectors of 3 numbers, joined by great circles, counter-clockwise from outside, with
 * x and y as the pixels have them and z along the normal; twice the corners of its polygon are enough. `used`: how many
 * there are; 0 where its front does not face the element. `form_factor`: the share of the base circle's area within,
 * which is the form factor from the middle with nothing between. */
TRP_API TrpStatus trp_radiosity_outline(TrpRadiosity* radiosity, uint32_t element, uint32_t seen, double* corners,
                                        size_t corner_count, size_t* used, double* form_factor);

typedef struct TrpRadiosityLink {
    uint32_t struct_size;
    uint32_t receiver, source;     /* elements; TRP_NO_ELEMENT: a group of them, or an element that was divided */
    float factor[3];               /* irradiance at the receiver for a radiosity of 1 at the source */
    float from[3], to[3];          /* the middles of source and receiver, world space */
    int32_t level;                 /* how often the receiver's face was divided; -1: a group of elements */
} TrpRadiosityLink;
#define TRP_NO_ELEMENT 0xFFFFFFFFu
/* Link `index`, from 0 to TrpRadiosityInfo.links, of the hierarchical solver. */
TRP_API TrpStatus trp_radiosity_link(TrpRadiosity* radiosity, uint64_t index, TrpRadiosityLink* link);

/* Those that bring light to an element: links to itself, and to what it is a part of. The first `capacity` of their
 * numbers go into `links`, which may be null where that is 0; `count` is how many there are. */
TRP_API TrpStatus trp_radiosity_element_links(TrpRadiosity* radiosity, uint32_t element, uint64_t* links,
                                              size_t capacity, size_t* count);
/* The element that is seen in the middle of a pixel (from the bottom left) of a render's film; TRP_NO_ELEMENT where there
 * is none. */
TRP_API TrpStatus trp_radiosity_pick(TrpRadiosity* radiosity, const TrpRender* render, uint32_t x, uint32_t y,
                                     uint32_t* element);

/* Has a render of the method "radiosity" show the solution as it is now, instead of finding one. TRP_ERROR_STATE where
 * the render's scene has other surfaces, or for another method. */
TRP_API TrpStatus trp_render_set_radiosity(TrpRender* render, TrpRadiosity* radiosity);

#ifdef __cplusplus
}
#endif
#endif
