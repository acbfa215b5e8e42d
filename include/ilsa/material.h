/*
 * Rock and fluid: the four scaled parameters of (2.1).
 *
 * A fluid with mu_prime = 0 has no viscosity, and one pressure everywhere in the fracture. A solver
 * lets a small viscosity stand for it, ten powers of ten below that which a penny of one cell would
 * feel at the rate of its start.
 */
#ifndef ILSA_MATERIAL_H
#define ILSA_MATERIAL_H

#include <ilsa/status.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ilsa_material ilsa_material;

/*
 * The units are any consistent set; those of SI are Pa, Pa s, Pa m^(1/2) and m s^(-1/2).
 * E_prime, and mu_prime unless it is 0, are 1e-60 .. 1e60 in a material; K_prime and C_prime are at
 * most 1e60. The tip functions of ilsa/tip.h take the whole double range.
 */
typedef struct ilsa_material_def {
    double E_prime;  /* plane strain modulus E / (1 - nu^2), > 0 */
    double mu_prime; /* scaled viscosity 12 mu, >= 0; with 0 the pressure is uniform */
    double K_prime;  /* scaled toughness 4 (2 / pi)^(1/2) K_Ic, >= 0, and > 0 where mu_prime = 0 */
    double C_prime;  /* scaled leak-off coefficient 2 C_L, >= 0 */
} ilsa_material_def;

/* Rock and fluid by the constants that a laboratory reports. */
typedef struct ilsa_rock {
    double E;    /* Young's modulus, stress, > 0 */
    double nu;   /* Poisson's ratio, 0 <= nu <= 0.5 */
    double mu;   /* dynamic viscosity of the fluid, stress time, >= 0 */
    double K_Ic; /* fracture toughness, stress length^(1/2), >= 0 */
    double C_L;  /* Carter's leak-off coefficient, length time^(-1/2), >= 0 */
} ilsa_rock;

/* Returns a definition of zeros, in which E_prime, and mu_prime or K_prime, must be set. */
ILSA_API ilsa_material_def ilsa_material_def_default(void);

/* Writes the scaled parameters (2.1) of a rock and its fluid. ILSA_ERR_NULL, ILSA_ERR_VALUE. */
ILSA_API ilsa_status ilsa_material_def_from_rock(const ilsa_rock *rock, ilsa_material_def *def);

/*
 * Makes a material. On success *material is a new handle owned by the caller, to be destroyed with
 * ilsa_material_destroy; otherwise *material is NULL.
 * ILSA_ERR_NULL, ILSA_ERR_VALUE, ILSA_ERR_MEMORY.
 */
ILSA_API ilsa_status ilsa_material_create(const ilsa_material_def *def, ilsa_material **material);

/* Destroys *material and sets it to NULL. material == NULL and *material == NULL are allowed. */
ILSA_API void ilsa_material_destroy(ilsa_material **material);

/* Writes the definition that the material was made with. ILSA_ERR_NULL. */
ILSA_API ilsa_status ilsa_material_get_def(const ilsa_material *material, ilsa_material_def *def);

#ifdef __cplusplus
}
#endif
#endif
