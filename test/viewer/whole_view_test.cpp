#include "viewer/whole_view.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

/// rviz sees 22.5 deg up and down; a picture that is as high as wide is its narrowest.
const double kEdge = std::tan(M_PI / 8.0);

struct Picture {
  double side, top, bottom;  // as tangents
};

/// The part of the picture that the points take.
Picture seen(const std::vector<Eigen::Vector3d>& points) {
  WholeView view;
  for (const Eigen::Vector3d& point : points) view.add(point);
  Picture picture = {0.0, -1.0, 1.0};
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d p = WholeView::orientation().inverse() * (point - view.position());
    EXPECT_GT(p.x(), 0.0) << "behind the camera";
    picture.side = std::max(picture.side, std::abs(p.y() / p.x()));
    picture.top = std::max(picture.top, p.z() / p.x());
    picture.bottom = std::min(picture.bottom, p.z() / p.x());
  }
  return picture;
}

void expectFilled(const std::vector<Eigen::Vector3d>& points) {
  const Picture picture = seen(points);
  EXPECT_LE(picture.side, 0.42 + 1e-9);
  EXPECT_LE(picture.top, kEdge);
  EXPECT_GE(picture.bottom, -kEdge);
  // The nearest such place: the points reach both sides, or top and bottom.
  const double height = picture.top - picture.bottom;
  EXPECT_TRUE(picture.side > 0.41 || height > 0.60) << picture.side << ", " << height;
}

TEST(WholeViewTest, WaysOfAnySizeFillThePicture) {
  for (const double size_m : {0.5, 50.0, 5000.0}) {
    std::vector<Eigen::Vector3d> ahead, aside, around;
    for (int i = 0; i <= 60; ++i) {
      const double angle = i * M_PI / 30.0;
      ahead.emplace_back(i * size_m / 60.0, 0.0, 0.0);
      aside.emplace_back(0.0, size_m * (1.0 + i / 60.0), 0.0);
      around.emplace_back(
          size_m * std::sin(angle), size_m * (1.0 - std::cos(angle)), 0.02 * i * size_m);
    }
    expectFilled(ahead);
    expectFilled(aside);
    expectFilled(around);
  }
}

}  // namespace
}  // namespace rotrocc
