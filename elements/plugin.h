/* The interface between Lacon and its plug-ins: plain C, so that a plug-in may be built by another compiler.
 *
 * A plug-in is a folder: a shared library lib<name>.so beside a plugin.toml, which holds catalogue rows of the shape of
 * catalog/elements/ and so says which kernel serves which element and option. The library has one entry point,
 * lacon_plugin(), which returns its table of kernels.
 *
 * Kernels work on blocks of LACON_LANES elements of one kind. The element is the fastest index of every array, so that a
 * loop over it vectorises; the last block is filled up by repeating an element. A kernel allocates nothing and throws nothing;
 * it reports what is wrong with an element in `error`. An output pointer may be NULL: that output is not wanted.
 */
#ifndef LACON_ELEMENTS_PLUGIN_H
#define LACON_ELEMENTS_PLUGIN_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define LACON_ABI 7
#define LACON_LANES 8

#if defined(__GNUC__)
#define LACON_PLUGIN_EXPORT __attribute__((visibility("default")))
#else
#define LACON_PLUGIN_EXPORT
#endif

/* Values of `error`. */
enum lacon_element_error {
  LACON_FINE = 0,
  LACON_BAD_JACOBIAN = 1,  /* zero, negative or of mixed sign at the integration points */
  LACON_BAD_PARAMETER = 2, /* a material parameter outside its range */
  LACON_NOT_FINITE = 3,
  LACON_BAD_BATCH = 4,   /* the kernel does not serve elements of this kind: the catalogue row is wrong */
  LACON_BAD_RADIUS = 5,  /* axisymmetry: a node on the wrong side of the axis, or a point on it */
  LACON_INSIDE_OUT = 6,  /* the displacement turns the element inside out. Matrix and force hold all the same, the stress does
                            not: Newton's method may pass through such a state, a solution may not be one */
  LACON_BEYOND_CURVE = 7 /* the hardening curve ends before the strain that was reached */
};

/* Solid elements: stiffness, internal forces, stresses at displacement u. ndof = n_nodes * n_unknowns, node by node: the
 * displacements, unless the kernel names its `unknowns`, whose values u then holds.
 * A law with a memory goes from the last state in equilibrium (`previous_...`) to that of u; a law without takes `previous_...`
 * as a state to start from, and none means the natural state: no displacement, no stress, variables zero. */
typedef struct lacon_solid_batch {
  uint32_t struct_size;
  int32_t n_blocks;
  int32_t n_nodes, dimension, n_points, n_stress, n_parameters;
  const double* shape;                 /* (n_points, n_nodes) */
  const double* gradient;              /* (n_points, n_nodes, dimension), by reference coordinates */
  const double* weight;                /* (n_points), of the reference cell */
  const double* coordinates;           /* (n_blocks, n_nodes, dimension, LANES), initial */
  const double* displacement;          /* (n_blocks, n_nodes, n_unknowns, LANES): u */
  const double* parameter;             /* (n_blocks, n_parameters, LANES), in the order of the kernel's `parameters` */
  double* matrix;                      /* (n_blocks, ndof (ndof + 1) / 2, LANES): lower triangle, row by row */
  double* force;                       /* (n_blocks, ndof, LANES) */
  double* stress;                      /* (n_blocks, n_points, n_stress, LANES) */
  int32_t* error;                      /* (n_blocks, LANES) */
  const double* previous_displacement; /* (n_blocks, n_nodes, n_unknowns, LANES) or NULL */
  const double* previous_stress;       /* (n_blocks, n_points, n_stress, LANES) or NULL */
  const double* previous_variable;     /* (n_blocks, n_points, n_variables, LANES) or NULL */
  double* variable;                    /* (n_blocks, n_points, n_variables, LANES): internal variables */
  const double* curve;                 /* (n_curve, 3), for all elements: plastic strain p from 0 on, yield stress R(p), slope
                                          behind p; a last slope that is not a number ends the curve */
  int32_t n_curve, n_variables;
  int32_t elastic_matrix;    /* 1: the matrix is that of the law's elastic part */
  int32_t stressless_matrix; /* 1: without the terms by which present stresses turn and move: the matrix is positive
                                semi-definite unless the law softens */
  int32_t n_unknowns;        /* of a node: as many as the kernel's `unknowns` */
  double* whole_matrix; /* (n_blocks, ndof, ndof, LANES), row by row: the tangent of an `unsymmetric` kernel as it is, where
                           `matrix` has its symmetric part */
  const double* thermal_strain;          /* (n_blocks, n_points, LANES): equal in all directions; of a kernel that takes it the
                                            stress is that of the strain less this. NULL: none */
  const double* previous_thermal_strain; /* likewise, of the last state */
} lacon_solid_batch;

/* Elements (bodies, skins, edges) under a load that has values at each integration point. ndof = n_nodes * n_unknowns. */
typedef struct lacon_load_batch {
  uint32_t struct_size;
  int32_t n_blocks;
  int32_t n_nodes, dimension, n_points; /* dimension of the space */
  int32_t reference_dimension;          /* of the cells */
  int32_t n_values;                     /* as many as the kernel's `parameters` */
  const double* shape;                  /* (n_points, n_nodes) */
  const double* gradient;               /* (n_points, n_nodes, reference_dimension) */
  const double* weight;                 /* (n_points) */
  const double* coordinates;            /* (n_blocks, n_nodes, dimension, LANES): initial, or current under a following load */
  const double* value;                  /* (n_blocks, n_points, n_values, LANES), in the order of the kernel's `parameters` */
  double* force;                        /* (n_blocks, ndof, LANES): external force */
  double* matrix;                       /* (n_blocks, ndof (ndof + 1) / 2, LANES), pressures only: lower triangle, row by row,
                                           of the symmetric part of the derivative of the force by the coordinates, zero
                                           for unknowns that are no displacements */
  int32_t* error;                       /* (n_blocks, LANES) */
  int32_t n_unknowns;                   /* of a node: as many as the kernel's `unknowns` */
} lacon_load_batch;

/* Contact cells, one for each couple (slave cell, master cell) of one pair of kinds; not in lanes, for the number of points
 * differs from cell to cell. Signs of DESIGN.md, section 3; formulas of METHOD.md 3.4 and 5.4 (b). */
typedef struct lacon_contact_batch {
  uint32_t struct_size;
  int32_t n_cells;
  int32_t n_slave_nodes, n_master_nodes, dimension;
  int32_t current_jacobian;     /* 0: TYPE_JACOBIEN INITIAL, 1: ACTUALISE */
  const int64_t* offset;        /* (n_cells + 1): points of each cell */
  const double* weight;         /* (points), in the slave's reference space */
  const double* slave_shape;    /* (points, n_slave_nodes) */
  const double* slave_gradient; /* (points, n_slave_nodes, dimension - 1) */
  const double* master_shape;   /* (points, n_master_nodes) */
  const double* slave_initial;  /* (n_cells, n_slave_nodes, dimension) */
  const double* slave;          /* (n_cells, n_slave_nodes, dimension), current */
  const double* master;         /* (n_cells, n_master_nodes, dimension), current */
  const double* slave_normal;   /* (n_cells, n_slave_nodes, dimension): nodal normals (LISSAGE), or NULL */
  double* point_gap;            /* (points): g = (x_m - x) . n_e */
  double* gap;                  /* (n_cells): G, integral of g with the measure of TYPE_JACOBIEN */
  double* measure;              /* (n_cells): integral of 1 with the same measure */
  double* current_measure;      /* (n_cells): integral of 1 with the current measure (COEFSURF) */
  double* coupling;             /* (n_cells, (n_slave_nodes + n_master_nodes) dimension): C, slave nodes first */
  int32_t* error;               /* (n_cells) */
} lacon_contact_batch;

enum lacon_kernel_kind { LACON_SOLID = 1, LACON_LOAD = 2, LACON_CONTACT = 3 };

typedef struct lacon_kernel {
  const char* name; /* as catalogue rows call it, behind "plug-in/" */
  int32_t kind;     /* lacon_kernel_kind: says which pointer below is set */
  void (*solid)(const lacon_solid_batch*);
  void (*load)(const lacon_load_batch*);
  void (*contact)(const lacon_contact_batch*);
  const char* const* parameters; /* solid: its material parameters, "ELAS/E"; load: its values, "PRES"; NULL at the end */
  const char* const* variables;  /* solid: names of the internal variables at a point, NULL at the end; or NULL: none */
  int32_t nonlinear;             /* solid: 0 if the matrix does not depend on the displacement */
  int32_t has_memory;            /* solid: 1 if the result depends on the last state in equilibrium */
  int32_t takes_curve;           /* solid: 1 if it needs the hardening curve */
  const char* const* unknowns;   /* solid, load: its unknowns at each node, "DX", "TEMP", some of its elements' `dofs`, NULL at
                                    the end; or NULL: the displacements */
  int32_t unsymmetric;           /* solid: 1 if its tangent is not symmetric, and `whole_matrix` may be asked for */
  int32_t takes_thermal_strain;  /* solid: 1 if it works with `thermal_strain` */
} lacon_kernel;

typedef struct lacon_plugin_table {
  uint32_t abi; /* LACON_ABI */

  /* sizeof of the structs it was built with */
  uint32_t solid_batch_size, load_batch_size, contact_batch_size;
  const char* name;
  int32_t n_kernels;
  const lacon_kernel* kernels;
} lacon_plugin_table;

/* The one entry point of a plug-in's library. */
LACON_PLUGIN_EXPORT const lacon_plugin_table* lacon_plugin(void);

#ifdef __cplusplus
}
#endif
#endif
