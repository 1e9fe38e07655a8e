# retex-import: cameras inside of rooms, their unit, their axis and their light. import_room.py has the models, and
# judges what a camera sees of them by a ray tracer of its own.
% judge() { /usr/bin/python3 $TESTS/import_room.py "$@"; }
$ judge

# From inside: the eye is 1.5 m above the floor, in free space, and sees furniture; also where the model's unit or
# axis is another one, all of its faces are turned, or each is there twice.
$ for m in room room_cm room_in room_z room_mm_z turned doubled back_sides; do
+     retex-import --exposure 0 -q $m.obj -o $m && judge view $m room && judge bounds $m
+ done
> a view
> 5 x 2.6 x 4
> a view
> 5 x 2.6 x 4
> a view
> 5 x 2.6 x 4
> a view
> 5 x 2.6 x 4
> a view
> 5 x 2.6 x 4
> a view
> 5 x 2.6 x 4
> a view
> 5 x 2.6 x 4
> a view
> 5 x 2.6 x 4
$ retex-import --exposure 0 -q ell.obj -o ell && judge view ell ell
> a view
$ for m in dark window glass lamp cm twice; do
+     retex-import --exposure 0 -q $m.gltf -o $m && judge view $m room && judge bounds $m
+ done
> a view
> 5 x 2.6 x 4
> a view
> 5 x 2.6 x 4
> a view
> 5 x 2.6 x 4
> a view
> 5 x 2.6 x 4
> a view
> 5 x 2.6 x 4
> a view
> 5 x 2.6 x 4

# A line tells of what was found, and which option says otherwise.
$ retex-import --exposure 0 -f room_cm.obj -o x 2>&1 | sed 's/from [-0-9.,]* to [-0-9.,]*/from A to B/'
> retex-import: the room is 260 units high: they are taken as centimetres, and become metres; --unit overrides
> retex-import: no camera in the model: the view is from inside; 19 % of it is furniture, 24 % floor, 7 objects are seen, from A to B 74 degrees
> retex-import: other views: View_2 from inside, View_3 from inside, View_4 from inside; --camera of retex-render takes one
> retex-import: no light in the model, and no opening in the room: a light below the ceiling, Ceiling_light, lights it
> retex-import: 6 materials, 7 meshes, 7 objects, 60 triangles
> retex-import: targets that are ready: Floor, Wall; -t of retex-render takes them by name
> retex-import: wrote x/x.pov
$ retex-import --exposure 0 -f room_z.obj -o x 2>&1 | sed 's/from [-0-9.,]* to [-0-9.,]*/from A to B/'
> retex-import: the model stands on its xy plane: z is taken as up; --up y overrides
> retex-import: no camera in the model: the view is from inside; 19 % of it is furniture, 24 % floor, 7 objects are seen, from A to B 74 degrees
> retex-import: other views: View_2 from inside, View_3 from inside, View_4 from inside; --camera of retex-render takes one
> retex-import: no light in the model, and no opening in the room: a light below the ceiling, Ceiling_light, lights it
> retex-import: 6 materials, 7 meshes, 7 objects, 60 triangles
> retex-import: targets that are ready: Floor, Wall; -t of retex-render takes them by name
> retex-import: wrote x/x.pov

# A room without a ceiling does not stand on a wall, whatever hangs there.
$ retex-import --exposure 0 -q lidless.obj -o lidless && judge bounds lidless
> 5 x 2.6 x 4

$ retex-import --exposure 0 -f doubled.obj -o x 2>&1 | grep ' lie'
> retex-import: 60 faces lie on others of the same corners: one of each is kept
$ retex-import --exposure 0 -f twice.gltf -o x 2>&1 | grep 'the same one'
> retex-import: 6 objects are where the same one is: one of each is kept
$ retex-import --exposure 0 -f two_panes.gltf -o x 2>&1 | grep ' lie'
= 1
$ retex-import --exposure 0 -f room_high.obj -o x 2>&1 | grep high
> retex-import: the room is 10.4 units high: its unit is unknown, and lengths stay; --unit ft, if it is feet, makes metres
$ retex-import --exposure 0 -f toy.gltf -o x 2>&1 | grep high
> retex-import: the room is 7.8 m high and so is its furniture: lengths stay, --scale 0.33 makes it 2.6 m
# Options say otherwise.
$ for o in '--unit m' '--unit 2cm' '--scale 2' '--up z' '--unit ft --scale 2'; do
+     retex-import --exposure 0 -f -q $o room_cm.obj -o x && judge bounds x
+ done
> 500 x 260 x 400
> 10 x 5.2 x 8
> 1000 x 520 x 800
> 5 x 4 x 2.6
> 304.8 x 158.5 x 243.8
$ for o in '--unit ft' '--up y'; do
+     retex-import --exposure 0 -f -q $o room_high.obj -o x && judge bounds x
+ done
> 6.096 x 3.17 x 4.877
> 20 x 10.4 x 16
$ retex-import --exposure 0 -f -q --up y room_z.obj -o x && judge bounds x
> 5 x 4 x 2.6
$ retex-import --exposure 0 -f --unit '3 miles' room.obj -o x
! retex-import: error: --unit: expected a length such as cm, 2.5cm or ft, not '3 miles'
= 2
$ retex-import --exposure 0 -f --unit 0 room.obj -o x
! retex-import: error: --unit: expected a length such as cm, 2.5cm or ft, not '0'
= 2

# From outside: what is no room. Of a room with two walls the open side is seen: from the right and from behind.
$ for m in plane solid hull shelves two_walls; do retex-import --exposure 0 $m.obj -o $m 2>&1 | grep -o 'the view is from outside'; done
> the view is from outside
> the view is from outside
> the view is from outside
> the view is from outside
> the view is from outside
$ sed -n '/^camera/,$p' two_walls/two_walls.pov |
+     awk '/^  location/ { gsub(/[<>,]/, ""); print ($2 > 4), ($4 > -2) }'
> 1 1

# From above into rooms, without walls and ceilings that stand before them: which ones follows from where their fronts
# are. All else stays.
$ for m in room.obj room_cm.obj turned.obj thick.obj ell.obj dark.gltf twice.gltf; do
+     case $m in thick.obj | ell.obj) room=${m%.obj} ;; *) room=room ;; esac
+     retex-import --exposure 0 -f -q --camera cutaway $m -o x && judge cut x $room
+ done
> cut
> cut
> cut
> cut
> cut
> cut
> cut
$ retex-import --exposure 0 -f --camera cutaway dark.gltf -o x 2>&1 | sed 's/from [-0-9.,]* to [-0-9.,]*/from A to B/'
> retex-import: the view is into the rooms from above, from A to B 40 degrees; 6 triangles before the rooms are left out
> retex-import: no light in the model: a soft sky lights it
> retex-import: 6 materials, 6 meshes, 6 objects, 54 triangles
> retex-import: wrote x/x.pov
# Glass, and meshes that are placed several times, stay or go as a whole.
$ for m in panes_before panes_behind shared; do
+     retex-import --exposure 0 -f -q --camera cutaway $m.gltf -o x
+     echo $(grep -c '^object.*Pane' x/x.pov) $(grep -c '^object' x/x.pov)
+ done
> 0 6
> 1 7
> 0 11
$ for m in plane solid hull passage; do retex-import --exposure 0 --camera cutaway $m.obj -o y; echo $?; done
> 2
> 2
> 2
> 2
! retex-import: error: --camera cutaway: plane.obj: there is no room in it
! retex-import: error: --camera cutaway: solid.obj: there is no room in it
! retex-import: error: --camera cutaway: hull.obj: there is no room in it
! retex-import: error: --camera cutaway: passage.obj: there is no room in it

# Cameras of the model come first; words stand for views, and a camera of such a name has its number.
$ retex-import --exposure 0 -f -q camera.gltf -o x && grep '^camera' x/x.pov
> camera { Camera_inside }
$ retex-import --exposure 0 -f -q --camera auto camera.gltf -o x && grep '^camera' x/x.pov
> camera { Camera_inside }
$ retex-import --exposure 0 -f -q --camera 1 camera.gltf -o x && grep '^camera' x/x.pov
> camera { Camera_inside }
# One that sees a wall alone is not used, even from afar, unless it is asked for. How good one is, against all other views.
$ retex-import --exposure 0 blind.gltf -o blind 2>&1 | grep 'the camera' && judge view blind room && grep -c '^#declare Camera_eye' blind/blind.pov
> retex-import: the camera Camera_eye sees nothing, or a wall before it; --camera Camera_eye takes it all the same
> a view
> 1
$ retex-import --exposure 0 behind.gltf -o behind 2>&1 | grep -o 'the camera .* sees nothing' && judge view behind room
> the camera Camera_eye sees nothing
> a view
$ retex-import --exposure 0 -f -q --camera Camera_eye blind.gltf -o x && grep '^camera' x/x.pov
> camera { Camera_eye }
$ retex-import --exposure 0 -f -v camera.gltf -o x 2>&1 | grep -o 'other views show more than.*'
> other views show more than Camera_inside
$ retex-render --list-cameras x/x.pov | cut -f1
> Camera_inside
> View_2
> View_3
> View_4
$ retex-import --exposure 0 -q --camera inside camera.gltf -o inside && judge view inside room
> a view
$ retex-import --exposure 0 -f --camera outside camera.gltf -o x 2>&1 | grep -o 'the view is from outside'
> the view is from outside
$ retex-import --exposure 0 -f -q --camera 1,1.5,-2:4,1,-1.5:65 camera.gltf -o x && grep -A5 '^camera' x/x.pov
> camera {
>   location <1, 1.5, -2>
>   right x * 4/3
>   up y
>   angle 65
>   look_at <4, 1, -1.5>
$ retex-import --exposure 0 -f -q --camera 1,1.5,-2:4,1,-1.5 camera.gltf -o x && grep angle x/x.pov | tail -1
>   angle 70
$ retex-import --exposure 0 --camera 1,1,1:1,1,1 camera.gltf -o y
! retex-import: error: --camera 1,1,1:1,1,1: the camera is where it looks at
= 2
$ retex-import --exposure 0 --camera 1,1,1:1,1,2:180 camera.gltf -o y
! retex-import: error: --camera 1,1,1:1,1,2:180: expected an angle from 1 to 170 degrees
= 2
$ retex-import --exposure 0 --camera 1,1:2,2,2 camera.gltf -o y
! retex-import: error: --camera 1,1:2,2,2: the model has 1 camera, the first is Camera_inside
= 2
$ retex-import --exposure 0 --camera inside solid.obj -o y
! retex-import: error: --camera inside: solid.obj: no place above a floor is free
= 2
$ ls -d y*
! ls: cannot access 'y*': No such file or directory
= 2

# Light: a closed room gets a lamp below its ceiling, one with an opening or a pane the sky. Those that have a lamp, if it
# is hidden too, get theirs switched off.
$ for m in dark hidden window glass lamp; do
+     retex-import --exposure 0 -f $m.gltf -o x 2>&1 | grep -o 'no light.*' || echo none
+     echo $(grep -c '^sky_sphere' x/x.pov) $(grep -c 'declare Ceiling_light' x/x.pov) $(grep -o 'Added_[a-z]* = .*;' x/x.pov)
+ done
> no light in the model, and no opening in the room: a light below the ceiling, Ceiling_light, lights it
> 0 1 Added_lamp = 1.000;
> none
> 0 1 Added_lamp = 0.000;
> no light in the model: a soft sky lights it
> 1 1 Added_lamp = 0.000; Added_sky = 1.000;
> no light in the model: a soft sky lights it
> 1 1 Added_lamp = 0.000; Added_sky = 1.000;
> none
> 0 1 Added_lamp = 0.000;
$ retex-render -q --spp 16 --size 64x48 dark/dark.pov -t Floor --lamp Ceiling_light -o dark.exr &&
+     retex-combine -q --auto-exposure dark.exr -o dark.png && oiiotool --stats dark.png |
+     awk '/Avg/ { print ($3 > 80 && $3 < 180) }'
> 1
$ retex-combine -q dark.exr -o lit.exr && retex-combine -q --light Ceiling_light=0.5 dark.exr -o half.exr &&
+     retex-combine -q --light Ceiling_light=0 dark.exr -o off.exr &&
+     oiiotool -q lit.exr half.exr --mulc 2 --absdiff -o both.exr && oiiotool --stats both.exr off.exr |
+     awk '/Max/ { print ($3 < .002) }'
> 1
> 1
# Without exposure it is sensible too; the light is below the ceiling of 2.6 m and faces down.
$ oiiotool --stats lit.exr | awk '/Avg/ { print ($3 > .1 && $3 < .6) }'
> 1
$ grep -A4 'declare Ceiling_light' dark/dark.pov | grep -o 'rotate.*translate.*' |
+     awk '{ print $2, ($5 > 2.5 && $5 < 2.6) }'
> 90*x 1
