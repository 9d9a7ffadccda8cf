#pragma once

#include <cstdint>

#include "simulation/surfaces/texture.h"

namespace rotrocc {

/// Textures of a street, generated from the seed, all with a mean of about 0.5.
struct TextureTiles {
  explicit TextureTiles(std::uint64_t seed);

  Texture asphalt;     ///< speckles, stains and cracks
  Texture paving;      ///< concrete slabs
  Texture grass;       ///< blades
  Texture leaves;      ///< of trees and hedges, light and dark
  Texture plaster;     ///< faint stains
  Texture bricks;      ///< rows with mortar between
  Texture roof_tiles;  ///< overlapping rows
  Texture bark;        ///< grooves along the second coordinate
  Texture writing;     ///< eight lines of words, in a tile of 1 m
  Texture blotches;    ///< soft and large: clouds, dirt, reflections
};

}  // namespace rotrocc
