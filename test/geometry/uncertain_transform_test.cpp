#include "rotrocc/uncertain_transform.h"

#include <random>

#include <gtest/gtest.h>

#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

/// Deterministic normal numbers.
class Noise {
 public:
  /// A sample of the transform: its estimate with a random error of its covariance.
  Eigen::Isometry3d sample(const UncertainTransform& transform) {
    Vector6d normal;
    for (int i = 0; i < 6; ++i) normal[i] = normal_(random_);
    const Vector6d error = transform.covariance.llt().matrixL() * normal;
    Eigen::Isometry3d T = transform.T;
    T.linear() = expRotation(error.tail<3>()) * transform.T.linear();
    T.translation() += error.head<3>();
    return T;
  }

 private:
  std::mt19937 random_{1};
  std::normal_distribution<double> normal_;
};

Eigen::Isometry3d makeTransform(const Eigen::Vector3d& translation,
                                const Eigen::Vector3d& rotation) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = translation;
  T.linear() = expRotation(rotation);
  return T;
}

/// A full covariance, with standard deviations of about `sigma_m` and `sigma_rad`.
Matrix6d makeCovariance(double sigma_m, double sigma_rad) {
  Matrix6d root;
  root << 1.0, 0.0, 0.0, 0.0, 0.0, 0.0,  //
      0.3, 0.8, 0.0, 0.0, 0.0, 0.0,      //
      -0.2, 0.4, 1.2, 0.0, 0.0, 0.0,     //
      0.5, 0.1, 0.2, 0.9, 0.0, 0.0,      //
      0.1, -0.6, 0.0, 0.2, 1.1, 0.0,     //
      0.0, 0.2, 0.7, -0.3, 0.1, 0.7;
  Vector6d scale;
  scale << Eigen::Vector3d::Constant(sigma_m), Eigen::Vector3d::Constant(sigma_rad);
  root = scale.asDiagonal() * root;
  return root * root.transpose();
}

Vector6d errorOf(const Eigen::Isometry3d& sample, const Eigen::Isometry3d& mean) {
  Vector6d error;
  error << sample.translation() - mean.translation(),
      logRotation(sample.linear() * mean.linear().transpose());
  return error;
}

/// Expects the covariance of 40000 samples, which has an error of about 1 % of the diagonal; the
/// limit is four times that.
template <class Sample>
void expectCovariance(const UncertainTransform& transform, Sample sample) {
  constexpr int kSamples = 40000;
  Matrix6d sum = Matrix6d::Zero();
  for (int i = 0; i < kSamples; ++i) {
    const Vector6d error = errorOf(sample(), transform.T);
    sum += error * error.transpose();
  }
  const Matrix6d sampled = sum / kSamples;
  const Vector6d sigma = transform.covariance.diagonal().cwiseSqrt();
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col < 6; ++col) {
      EXPECT_NEAR(sampled(row, col), transform.covariance(row, col), 0.04 * sigma[row] * sigma[col])
          << row << ", " << col;
    }
  }
}

TEST(UncertainTransformTest, ErrorsAreThoseOfSamples) {
  Noise noise;
  const UncertainTransform a{makeTransform({10.0, -4.0, 1.0}, {0.3, -0.2, 1.9}),
                             makeCovariance(0.05, 0.004)};
  const UncertainTransform b{makeTransform({5.0, 1.0, -3.0}, {-0.1, 0.4, 0.2}),
                             makeCovariance(0.02, 0.006)};
  EXPECT_TRUE(compose(a, b).T.isApprox(a.T * b.T));
  expectCovariance(compose(a, b), [&] { return noise.sample(a) * noise.sample(b); });
  EXPECT_TRUE(inverse(b).T.isApprox(b.T.inverse()));
  expectCovariance(inverse(b), [&] { return noise.sample(b).inverse(); });
}

}  // namespace
}  // namespace rotrocc
