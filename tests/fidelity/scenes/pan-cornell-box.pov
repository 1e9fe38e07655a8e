// The Cornell box, by a camera that moves to the right by 20 cm while clock goes from 0 to 1. Target: Floor.
//
//   retex-render -I scenes/cornell-box pan-cornell-box.pov -t Floor --frames 1-12 -o box-%02d.exr

#include "cornell-box.pov"

camera {
  location Eye + (clock - .5) * .2 * x
  direction <0, 1, -1> - Eye
  right 2.04 * x
  up 2.04 * y
}
