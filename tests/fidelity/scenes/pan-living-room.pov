// The living room, by a camera that turns by 6 degrees to the right while clock goes from 0 to 1. Targets: Floor, Wall.
//
//   retex-render -I scenes/living-room pan-living-room.pov -t Floor -t Wall --frames 1-12 -o room-%02d.exr

#include "living-room.pov"

#declare Eye = <-0.75, 1.32, -2.95>;
camera {
  right x * 16/9
  up y
  angle 70
  location Eye
  look_at Eye + vrotate(<0.61, -0.46, 3.95>, y * (clock - .5) * 6)
}
