/* The suite inside another process: fitted scattering functions (.sqt), prepared scenes (.h5) and the light of
 * simulations, asked for whole arrays at once, on all cores. Plain C; libremote_scenes.so.1 keeps what stands here.
 *
 * Conventions: SI, wavelengths in um; angles in rad. Arrays lie one row after the other, n x 3 for places and
 * directions. Directions are unit vectors (within 1e-6) and point away from the surface; of a fitted function in the
 * surface's own frame, z its normal; of scenes ENU (x east, y north, z up). Functions return 0, or RS_INPUT when the
 * input is at fault, RS_BUG when the suite is; rs_message() then tells what is wrong and where, as the programs do.
 * Nothing is written to the arrays of a refused call but by rs_scene_trace and rs_simulation_radiance. Objects may be
 * asked by several threads at once, and closed at any moment: calls on their way come to their end, later ones are
 * refused. Their pointers are handles and lead to no memory; none is given twice.
 */
#ifndef REMOTE_SCENES_H
#define REMOTE_SCENES_H
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RS_INTERFACE 3 /* of this header; grows when functions are added */
enum { RS_OK = 0, RS_INPUT = 1, RS_BUG = 3 };

int rs_interface(void);       /* RS_INTERFACE of the library */
const char* rs_version(void); /* of the suite, as "0.9.0" */
const char* rs_message(void); /* of the last refused call of this thread, without a line's end; empty before */

const char* rs_told(void); /* what the last rs_simulation_... of this thread has to warn of, a sentence a line */

/* Threads for calls from now on, of the whole process; 0 = one a core. */
int rs_set_threads(int threads);

/* ---- fitted scattering functions ---- */

typedef struct rs_sqt rs_sqt;

int rs_sqt_open(const char* path, rs_sqt** sqt); /* *sqt stays as it is when refused */
void rs_sqt_close(rs_sqt* sqt);                  /* NULL is none */
const char* rs_sqt_header(const rs_sqt* sqt);    /* JSON: what was fitted, from what, with which errors (FORMAT.md) */

typedef struct rs_sqt_info {
  size_t channels;             /* wavelengths at which the shape is kept */
  size_t totals;               /* wavelengths of the finer table of totals */
  const double* wavelength_um; /* of the channels; as long as the function is open */
  const double* total_um;      /* ascending */
  int cosine; /* 1: a BSDF, whose weight is f |cos in|; 0: phase functions and lamps, whose weight is f */
  int sphere; /* 1: `in` may lie on both sides */
  int dirac;  /* 0 none, 1 mirror, 2 back to where it came from, 3 straight on */
} rs_sqt_info;
void rs_sqt_describe(const rs_sqt* sqt, rs_sqt_info* info);

/* f, 1/sr, without cosine: n x channels. 0 below the horizon. */
int rs_sqt_evaluate(const rs_sqt* sqt, size_t n, const double* out, const double* in, double* f);
/* The part of light of each channel that comes back to `out` (n x channels), of all there is, Dirac lobe included: the
 * integral of the weight over `in`. */
int rs_sqt_total(const rs_sqt* sqt, size_t n, const double* out, double* total);
/* The same at the wavelengths of the finer table: n x totals. */
int rs_sqt_magnitude(const rs_sqt* sqt, size_t n, const double* out, double* total);
/* Directions drawn by three numbers each in [0, 1) (n x 3), and their densities, 1/sr (n; may be NULL). Never the Dirac
 * lobe. A draw may fail: NaN, density 0; densities integrate to less than 1 then. */
int rs_sqt_sample(const rs_sqt* sqt, size_t n, const double* out, size_t channel, const double* u, double* in,
                  double* pdf);
/* The density of what rs_sqt_sample does: n x channels. */
int rs_sqt_pdf(const rs_sqt* sqt, size_t n, const double* out, const double* in, double* pdf);
/* The Dirac lobe: its directions (n x 3) and its part of the total (n); NaN and 0 where there is none. */
int rs_sqt_dirac(const rs_sqt* sqt, size_t n, const double* out, size_t channel, double* in, double* total);

/* ---- prepared scenes ---- */

typedef struct rs_scene rs_scene;

/* As it is between two times, s (begin <= end): rays have times within. */
int rs_scene_open(const char* path, double begin, double end, rs_scene** scene);
void rs_scene_close(rs_scene* scene); /* NULL is none */

typedef struct rs_scene_info {
  size_t materials, tags;                       /* names: 0 to one less */
  size_t triangles;                             /* of instances each time counted; SIZE_MAX: more than can be */
  double low[3], high[3];                       /* what has an end lies within, ENU; low > high: nothing does */
  double latitude_deg, longitude_deg, height_m; /* of the origin, WGS84 */
} rs_scene_info;
void rs_scene_describe(const rs_scene* scene, rs_scene_info* info);
const char* rs_scene_material(const rs_scene* scene, size_t number); /* NULL beyond the last */
const char* rs_scene_tag(const rs_scene* scene, size_t number);

/* Where answers go; those that are NULL are not wanted. Where nothing is met: infinity, NaN, -1. */
typedef struct rs_hits {
  double* distance;  /* n: m */
  double* position;  /* n x 3: ENU, m */
  double* normal;    /* n x 3: of the geometry, on its front side */
  int64_t* material; /* n: after overrides and class maps; -1 also where the surface has none */
  int64_t* instance; /* n: numbers of truth images */
  int64_t* tag;      /* n: -1 also where there is none */
  int64_t* triangle; /* n: of the mesh; -1 on exact surfaces */
} rs_hits;

/* What rays meet first. time: s, n, or NULL for the beginning. Leaves through whose holes (opacity maps) rays pass are
 * there or not by a hash of the ray and of draw (n, or NULL for 0). */
int rs_scene_trace(const rs_scene* scene, size_t n, const double* origin, const double* direction, const double* time,
                   const uint32_t* draw, const rs_hits* hits);
/* visible (n): 1 where no surface stands between two places, whatever its material is and lets through; media do not
 * count. Surfaces nearer to either place than gap (m, >= 0) do not stand between: of places on surfaces. */
int rs_scene_visible(const rs_scene* scene, size_t n, const double* from, const double* to, double gap,
                     const double* time, uint8_t* visible);

/* ---- radiance of rays ---- */

typedef struct rs_simulation rs_simulation;

/* A simulation's text, as dirsig-render reads it, with the scenes that it names: its lights, air, media and options
 * light the rays. sensor: whose bands and numbers of paths they have, by name; NULL: the only one. RS_INPUT also for
 * sensors of several spectral states, and for temperatures that follow from weather where a band sees them. */
int rs_simulation_open(const char* path, const char* sensor, rs_simulation** simulation);
void rs_simulation_close(rs_simulation* simulation); /* NULL is none */

typedef struct rs_simulation_info {
  size_t bands;
  uint32_t paths;    /* at most, of a ray, as the sensor has it */
  uint64_t seed;     /* of the text */
  double begin, end; /* s, of the sensor's first capture */
} rs_simulation_info;
void rs_simulation_describe(const rs_simulation* simulation, rs_simulation_info* info);
const char* rs_simulation_band(const rs_simulation* simulation, size_t number, double* center_um); /* NULL beyond */

/* What comes along rays, W/(m2 sr um), with its standard error: n x bands each; quality (n, or NULL): flags of
 * dirsig-render's quality image. time: s, n, or NULL for `begin`; rays of one time are rendered together, the sun where
 * it is then. paths: of each ray; 0: as the sensor says, its target for errors included. seed: 0 to 2^53. The
 * bits are those of a `point` sensor that looks along the rays in this order at this time, for any number of threads;
 * random numbers go by a ray's place among those of its time. */
int rs_simulation_radiance(const rs_simulation* simulation, size_t n, const double* origin, const double* direction,
                           const double* time, uint32_t paths, uint64_t seed, double* radiance, double* standard_error,
                           uint8_t* quality);

/* ---- pulses of laser radars (interface 3) ---- */

typedef struct rs_lidar rs_lidar;

/* A laser radar of a simulation's text, by name; NULL: the only one. Its detectors are not read. */
int rs_lidar_open(const char* path, const char* sensor, rs_lidar** lidar);
void rs_lidar_close(rs_lidar* lidar); /* NULL is none */

typedef struct rs_lidar_info {
  uint64_t pulses; /* shots of the clock; at some no beam may leave the scanner */
  uint64_t seed;   /* of the text */
  uint32_t paths;  /* a pulse and pixel */
  uint32_t bins;   /* of a pulse */
  uint32_t columns, rows;
  size_t channels;
  double bin_s, group_index;
} rs_lidar_info;
void rs_lidar_describe(const rs_lidar* lidar, rs_lidar_info* info);
const char* rs_lidar_channel(const rs_lidar* lidar, size_t number); /* NULL beyond the last */

/* Traces shots [first, first + count), as far as there are so many. paths: a pulse and pixel; 0: as the text says.
 * seed: 0 to 2^53. The bits are those of dirsig-render, for any number of threads and wherever calls begin. Not
 * refused: no shot at all. */
typedef struct rs_responses rs_responses;
int rs_lidar_trace(const rs_lidar* lidar, uint64_t first, uint64_t count, uint32_t paths, uint64_t seed,
                   rs_responses** traced);
void rs_responses_close(rs_responses* traced); /* NULL is none */

/* As in a file of responses (formats/response/FORMAT.md), pulses without a beam left out. As long as they are open. */
typedef struct rs_response_arrays {
  uint64_t pulses, rows, entries;
  const double *time, *energy, *wavelength_um, *start; /* of pulses: s, J, um, s after the emission */
  const double *emission_place, *emission_rotation;    /* pulses x 3, ENU m; x 4, w x y z */
  const double *reception_place, *reception_rotation;
  const uint64_t* begin;               /* rows + 1: first entry of each row, and the end */
  const double* bound;                 /* of rows: photons; NaN = nothing is known */
  const uint64_t* paths;               /* of rows */
  const uint32_t *bin, *contributions; /* of entries; bin 0 = passive light */
  const double *value, *variance;      /* entries x channels: photons */
  const float* skewness;               /* entries x channels: of the scrambles */
  double scrambles, student;           /* their number, Student's quantile at 95 % */
} rs_response_arrays;
void rs_responses_describe(const rs_responses* traced, rs_response_arrays* arrays);

#ifdef __cplusplus
}
#endif
#endif
