// Scattering by a hair: a rough dielectric cylinder with an absorbing inside and tilted scales. Marschner et al.,
// Light Scattering from Human Hair Fibers, 2003; d'Eon et al., An Energy-Conserving Hair Reflectance Model, 2011;
// Chiang et al., A Practical and Controllable Hair and Fur Model for Production Path Tracing, 2016; as put together
// in Pharr, The Implementation of a Hair Scattering Model, 2016.
//
// The fibre runs along dpdu. Light is a sum over p, the number of its passages through the inside: R (p = 0, off the
// surface), TT, TRT, and all further ones as one term without a direction of their own. The lobe's parameters are
//   a  the offset h in [-1, 1] of the ray from the axis, over the radius;
//   b  the longitudinal variance of R, > 0 (the others follow from it);
//   c  the scale of the azimuthal logistic distribution, > 0;
//   d  the tilt of the scales in radians;
//   colour1  the absorption of the inside per radius;  eta  the relative index of refraction.
#pragma once

namespace whit {

/// The longitudinal variance of R of a user's roughness in [0, 1]. Chiang et al. 2016.
float hair_variance(float beta_m);
/// The scale of the logistic distribution of a user's roughness in [0, 1]. Chiang et al. 2016.
float hair_azimuthal_scale(float beta_n);

}  // namespace whit
