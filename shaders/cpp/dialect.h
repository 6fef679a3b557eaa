// The dialect of shaders/lobe, C++ side: included inside a namespace where `Real` is already float or double. No include guard: once per
// precision. GLM has GLSL's names; what it lacks stays undeclared, so that using it is an error and never a wrong answer.
using Vec2 = glm::vec<2, Real, glm::defaultp>;
using Vec3 = glm::vec<3, Real, glm::defaultp>;
using Vec4 = glm::vec<4, Real, glm::defaultp>;
using Mat3 = glm::mat<3, 3, Real, glm::defaultp>;
using IVec2 = glm::ivec2;

using glm::abs;
using glm::ceil;
using glm::cos;
using glm::cross;
using glm::dot;
using glm::exp;
using glm::floor;
using glm::log;
using glm::max;
using glm::min;
using glm::mix;
using glm::pow;
using glm::sin;
using glm::sqrt;

inline bool isNotANumber(Real x) { return x != x; }
inline Real notANumber() { return std::numeric_limits<Real>::quiet_NaN(); }
inline Real positiveInfinity() { return std::numeric_limits<Real>::infinity(); }
