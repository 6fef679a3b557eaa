// Suns, spheres and disks of uniform radiance L, each seen from a point as a cap of the sphere of directions: a disc of half-angle s about
// an axis. Sphere and sun are such a cap exactly. A disk is replaced by the cap of the same vector irradiance (the integral of w L over its
// directions), which has a closed form; that keeps the irradiance of every surface that sees the whole of it.
//
// A cap as a spherical Gaussian keeps two moments: the flux, 2 pi (1 - cos s) L, and the mean cosine, (1 + cos s) / 2. With both the irradiance of a
// surface that faces it is exact, pi sin^2 s L, and so is the deviation of a shadow's edge, s / 2 for small s. (Matching the peak instead
// makes the deviation 1.4 times too large.) The shape is not kept: the Gaussian's peak is 2 L. So mirrors, which show the shape, use
// capMeanUnderLobe(). Nothing here divides by the light's size, so a size of 0 is the punctual light.
#ifndef CHIARO_CPP
#include "shaders/lobe/cosine.glsl"
#endif

struct LightCap {
  Vec3 axis;        // towards the light, unit
  Real sinSquared;  // sin^2 s; 1 where the light is all around
  Real cosine;      // cos s; -1 where the light is all around
  Real irradiance;  // of a surface that faces the axis, pi sin^2 s L, for an intensity of 1 (candela; of a sun lux)
  Real flux;        // integral of L over the cap
};

// Squared distances below this are taken as this, m^2.
CONST Real kLeastDistanceSquared = Real(1.0e-12);

FN LightCap lightCap(IN(Vec3) axis, IN(Real) sinSquared, IN(Real) cosine, IN(Real) irradiance) {
  LightCap cap;
  cap.axis = axis;
  cap.sinSquared = sinSquared;
  cap.cosine = cosine;
  cap.irradiance = irradiance;
  cap.flux = cosine < Real(0.0) ? Real(4.0) * irradiance : irradiance * Real(2.0) / (Real(1.0) + cosine);
  return cap;
}

// towards: unit, towards its middle; angle in [0, pi/2], its angular radius.
FN LightCap sunCap(IN(Vec3) towards, IN(Real) angle) {
  Real s = clampReal(angle, Real(0.0), kHalfPi);
  Real sine = sinQuarter(s);
  return lightCap(towards, sine * sine, sinQuarter(kHalfPi - s), Real(1.0));
}

// A vector's length (x) and what to multiply it with to make it unit (y), without overflow; (0, 0) for none.
FN Vec2 lengthAndScale(IN(Vec3) v) {
  Real largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
  if (!(largest > Real(0.0))) return Vec2(largest, Real(0.0));
  Vec3 n = v * (Real(1.0) / largest);
  Real relative = sqrt(dot(n, n));
  return Vec2(relative * largest, Real(1.0) / largest / relative);
}

// towards: from the point to the sphere's centre, metres. Of intensity I, so L = I / (pi radius^2): from outside the irradiance is I / d^2 at every
// distance. Inside, the shell shines all around with the same L, and the irradiance of every surface is I / radius^2.
FN LightCap sphereCap(IN(Vec3) towards, IN(Real) radius) {
  Vec2 known = lengthAndScale(towards);
  Vec3 axis = known.y > Real(0.0) ? towards * known.y : Vec3(Real(0.0), Real(1.0), Real(0.0));
  Real d = known.x;
  if (d < radius) return lightCap(axis, Real(1.0), -Real(1.0), Real(1.0) / max(radius * radius, kLeastDistanceSquared));
  Real sine = d > Real(0.0) ? radius / d : Real(0.0);
  return lightCap(axis, sine * sine, sqrt(max(Real(0.0), (Real(1.0) - sine) * (Real(1.0) + sine))), Real(1.0) / max(d * d, kLeastDistanceSquared));
}

// A one-sided disk of the given centre (towards, as above) whose light travels along unit `direction`; Lambert's, of intensity I on its axis.
// With h the height over its plane and a the distance from its axis, the vector irradiance over I is
//   2 h^2 / (q (q + m)) against the direction, 2 h a / (q (q + p)) towards the axis;  m = h^2 + a^2 - r^2, p = h^2 + a^2 + r^2,
//   q^2 = p^2 - 4 a^2 r^2 = m^2 + 4 h^2 r^2
// (the form factors of a disk for planes along and across it, without their differences of nearly equal numbers). Behind it: nothing.
FN LightCap diskCap(IN(Vec3) towards, IN(Vec3) direction, IN(Real) radius) {
  Vec2 known = lengthAndScale(towards);
  Real size = max(max(known.x, radius), sqrt(kLeastDistanceSquared));
  Vec3 o = towards * (Real(1.0) / size);
  Real r = radius / size;
  Real height = -dot(o, direction);
  Vec3 across = o + direction * height;
  if (!(height > Real(0.0)) && !isNotANumber(height)) return lightCap(-direction, Real(0.0), Real(1.0), Real(0.0));
  Real h = max(height, Real(1.0e-9));  // keeps q above 0 on the rim
  Real a2 = dot(across, across);
  Real distance = sqrt(h * h + a2);
  Real m = (distance - r) * (distance + r);
  Real p = h * h + a2 + r * r;
  Real q = sqrt(m * m + Real(4.0) * h * h * r * r);
  Real down = m > Real(0.0) ? Real(2.0) * h * h / (q * (q + m)) : (q - m) / (Real(2.0) * r * r * q);
  Vec3 vectorIrradiance = across * (Real(2.0) * h / (q * (q + p))) - direction * down;
  Vec2 found = lengthAndScale(vectorIrradiance);
  Real sinSquared = min(Real(1.0), r * r * found.x);
  return lightCap(vectorIrradiance * found.y, sinSquared, sqrt(Real(1.0) - sinSquared), found.x / (size * size));
}

// Sharpness of the SG of the cap's mean cosine; 0 all around, kMaxSharpness where the cap is a point.
FN Real capSharpness(IN(LightCap) cap) {
  if (cap.cosine < Real(0.0)) return Real(0.0);
  Real deficit = Real(0.5) * cap.sinSquared / (Real(1.0) + cap.cosine);
  if (isNotANumber(deficit)) return deficit;
  if (deficit < Real(0.01)) return deficit > Real(1.0) / kMaxSharpness ? Real(1.0) / deficit : kMaxSharpness;  // to e^-200
  return vmfSharpness(Real(1.0) - deficit, deficit);
}

// Two lobes' sharpness after one is blurred by the other: variances add.
FN Real blurredSharpness(IN(Real) sharpness, IN(Real) blur) {
  Real larger = max(sharpness, blur);
  return larger > Real(0.0) ? min(sharpness, blur) / (Real(1.0) + min(sharpness, blur) / larger) : larger;
}

// atan(x) - x for x in [0, 1/2], relative error 3e-9.
FN Real atanMinusArgument(IN(Real) x) {
  Real t = x * x;
  return -x * t * (Real(1.0 / 3.0) + t * (-Real(1.0 / 5.0) + t * (Real(1.0 / 7.0) + t * (-Real(1.0 / 9.0) + t * (Real(1.0 / 11.0)
       + t * (-Real(1.0 / 13.0) + t * (Real(1.0 / 15.0) + t * (-Real(1.0 / 17.0) + t * (Real(1.0 / 19.0) - t * Real(1.0 / 21.0))))))))));
}

// Irradiance of a surface whose normal is at `cosine` to the axis over that of one that faces it, the part below its horizon left out:
//   c+ where the cap is all above the horizon, else, with v = sqrt(sin^2 s - c^2),
//   (c atan2(v, -c cos s) + (atan(v / cos s) - v cos s) / sin^2 s) / pi
// (the closed form for a sphere cut by the horizon). All around: 1.
FN Real capIrradianceShare(IN(LightCap) cap, IN(Real) cosine) {
  if (cap.cosine < Real(0.0)) return Real(1.0);
  Real c = clampReal(cosine, -Real(1.0), Real(1.0));
  if (isNotANumber(c) || isNotANumber(cap.sinSquared)) return notANumber();
  Real sine = sqrt(cap.sinSquared);
  if (sine < Real(1.0e-9) || c >= sine) return max(c, Real(0.0));
  if (c <= -sine) return Real(0.0);
  Real v = sqrt((sine - c) * (sine + c));
  Real along = c * cap.cosine;
  Real angle = along > Real(0.0) ? kPi - atanQuadrant(v, along) : atanQuadrant(v, -along);
  Real rest;
  if (v < Real(0.5) * cap.cosine) {  // atan k - k + k sin^2 s, k = v / cos s: the first two cancel
    Real k = v / cap.cosine;
    rest = atanMinusArgument(k) / cap.sinSquared + k;
  } else {
    rest = (atanQuadrant(v, cap.cosine) - v * cap.cosine) / cap.sinSquared;
  }
  return clampReal((c * angle + rest) * kOneOverPi, Real(0.0), Real(1.0));
}

// Mean radiance under a normalised SG lobe (the share of the lobe in the cap times L) over the cap's irradiance, 1/sr. In Lambert's projection about the
// cap's axis a lobe is a Gaussian to first order; with b = sqrt(lambda) 2 sin(s/2) and a = sqrt(lambda) 2 sin(angle between the axes / 2) its share in a
// disc of radius b (Marcum's Q function) is nearly
//   (1 - e^(-b^2/2)) (erf((h - a)/sqrt 2) + erf((h + a)/sqrt 2)) / (2 erf(h/sqrt 2)),
// exact on the axis for every h. Our h = b sqrt(r(b^2)) makes its integral over the plane exact too: it tends to the Gaussian itself for small b, and to a
// straight edge at a = b for large. Largest error .0085 (at b = 2.6). For large caps h - a is corrected towards the true angle between the edge
// and the axis. Of the largest value: .01 for s up to .5, .025 at 1, .05 at pi/2, for sharpness 10 and more; below that, .02, .08, .2.
FN Real capMeanUnderLobe(IN(LightCap) cap, IN(Vec3) axis, IN(Real) sharpness) {
  if (cap.cosine < Real(0.0)) return kOneOverPi;
  Real l = clampSharpness(sharpness);
  Real root = sqrt(l);
  Real versine2 = Real(2.0) * cap.sinSquared / (Real(1.0) + cap.cosine);  // (2 sin(s/2))^2
  Real chordCap = sqrt(versine2);
  Vec3 difference = axis - cap.axis;
  Vec3 sum = axis + cap.axis;
  Real chord = min(sqrt(dot(difference, difference)), Real(2.0));
  Real b2 = l * versine2;
  Real r;
  if (b2 < Real(1.0)) {
    r = (Real(0.75) + b2 * (Real(0.12409645) + b2 * (Real(0.01060302) + b2 * Real(0.00113352))))
      / (Real(1.0) + b2 * (Real(0.13173656) + b2 * (Real(0.0117739) + b2 * Real(0.00113352))));
  } else {
    Real i = Real(1.0) / b2;
    r = (Real(0.00113352) + i * (Real(0.01060302) + i * (Real(0.12409645) + i * Real(0.75))))
      / (Real(0.00113352) + i * (Real(0.0117739) + i * (Real(0.13173656) + i)));
  }
  Real h = root * chordCap * sqrt(r);
  Real a = root * chord;
  // Angles over chords, for the edge of a large cap.
  Real capExcess = atanQuadrant(sqrt(cap.sinSquared), cap.cosine) - chordCap;
  Real excess = Real(2.0) * atanQuadrant(chord, sqrt(dot(sum, sum))) - chord;
  Real correction = b2 / (b2 + Real(4.0)) * root * (capExcess - excess);
  Real ratio;  // of the two erf over that of h
  if (h < Real(0.5)) {  // as the integral of the Gaussian between them: three Gauss points
    Real width = max(Real(2.0) * h + correction, Real(0.0));
    Real middle = a - Real(0.5) * correction;
    Real offset = Real(0.387298335) * width;
    Real mean = (Real(4.0) * exp(-Real(0.5) * middle * middle) + Real(2.5) * (exp(-Real(0.5) * (middle - offset) * (middle - offset))
              + exp(-Real(0.5) * (middle + offset) * (middle + offset)))) / Real(9.0);
    Real relativeWidth = h > Real(0.0) ? width / h : Real(2.0);
    // erf(h / sqrt 2) / h = erfOverArgument(h^2 / 2) / sqrt 2; 1 / sqrt(2 pi) of the Gaussian.
    ratio = relativeWidth * mean * kOneOverSqrtPi / erfOverArgument(Real(0.5) * h * h);
  } else {
    Real from = (h - a + correction) * Real(0.707106781186547524);
    Real to = (h + a) * Real(0.707106781186547524);
    ratio = max(Real(0.5) * (errorFunction(from) + errorFunction(to)), Real(0.0)) / errorFunction(h * Real(0.707106781186547524));
  }
  return oneMinusExpOver(Real(0.5) * b2) * ratio / (kTwoPi * (Real(1.0) + cap.cosine) * oneMinusExpOver(Real(2.0) * l));
}

// Seven directions that stand for a cap, as for a disc in Lambert's projection (Radon's rule, exact for polynomials of degree five): the axis with weight
// 1/4, six about it with 1/8 each. x and y are unit and span the plane across the axis; index in 0..6.
CONST int kCapPoints = 7;
FN Real capPointWeight(IN(int) index) { return index == 0 ? Real(0.25) : Real(0.125); }
FN Vec3 capPoint(IN(LightCap) cap, IN(Vec3) x, IN(Vec3) y, IN(int) index) {
  if (index == 0) return cap.axis;
  Real versine = cap.cosine < Real(0.0) ? Real(4.0 / 3.0) : Real(2.0 / 3.0) * cap.sinSquared / (Real(1.0) + cap.cosine);
  Real sine = sqrt(versine * (Real(2.0) - versine));
  Real turn = Real(index - 1) / Real(3.0) - Real(5.0 / 6.0);  // of pi, in (-1, 1)
  return cap.axis * (Real(1.0) - versine) + x * (sine * cosPi(turn)) + y * (sine * sinPi(turn));
}

// Share of a lamp's reflection that lobes give; the rest comes from the BRDF at capPoint(). Those serve lights narrower than the reflection (alpha, the
// narrower of two), exactly where the light is a point; lobes serve the others, whose shape the reflection shows.
FN Real capThroughLobes(IN(LightCap) cap, IN(Real) alpha) {
  Real t = clampReal(sqrt(cap.sinSquared) / alpha - Real(1.0), Real(0.0), Real(1.0));
  return t * t * (Real(3.0) - Real(2.0) * t);
}
