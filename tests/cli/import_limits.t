# retex-import: what models of few bytes may take. import_limits.py has them. Times are ratios of processor time.
% limits() { /usr/bin/python3 $TESTS/import_limits.py "$@"; }
% takes_less() { # COUNT OTHER MODEL: than so many times what OTHER takes
%     for m in "$2" "$3"; do limits processor retex-import --exposure 0 -q -f $m.glb -o took; done |
%         awk -v count="$1" 'NR == 1 { most = count * $1 } NR == 2 && $1 > most { print $1 " s, not " most }'
% }
$ limits

# Surfaces at one place: 200 floors are looked at as rooms are; of 4000, whose corners are the same or not, and of nodes
# within nodes, no ray is asked.
$ for m in one some turned same doubled; do
+     echo $m: $(retex-import --exposure 0 $m.glb -o $m 2>&1 | grep -o -e 'no room' -e 'view is from outside')
+ done
> one: view is from outside
> some: view is from outside
> turned: no room view is from outside
> same: no room view is from outside
> doubled: no room view is from outside
$ for m in turned same doubled; do takes_less 3 some $m; done

# Nodes count as often as they are placed.
$ retex-import --exposure 0 -q deep.glb -o deep
$ for m in deeper doubled_more lists; do retex-import --exposure 0 $m.glb -o $m; done
! retex-import: error: deeper.glb: its nodes lie within one another more than 4000 deep, or within themselves
! retex-import: error: doubled_more.glb: it has more than 1000000 nodes, each counted as often as it is placed
! retex-import: error: lists.glb: its JSON text: maximum parsing depth reached near '['
= 2

# Elements that lie in no buffer count as often as meshes use them.
$ retex-import --exposure 0 -q sparse.glb -o sparse
$ for m in sparse_big sparse_often; do retex-import --exposure 0 $m.glb -o $m; done
! retex-import: error: sparse_big.glb: its meshes have more than 16777216 elements that lie in no buffer
! retex-import: error: sparse_often.glb: its meshes have more than 16777216 elements that lie in no buffer
= 2
$ ls -d deeper* doubled_more* lists* sparse_*
> deeper.glb
> doubled_more.glb
> lists.glb
> sparse_big.glb
> sparse_often.glb

# Without a word of the user's there are limits, too, and reaching one is told. Time is told to the process that reads.
$ for i in $(seq 100000); do echo "v $i 0 0"; done >slow.obj && for i in $(seq 5); do cat slow.obj; done >slower.obj &&
+     echo 'f 1 2 3' >>slower.obj
$ limits limits retex-import --exposure 0 -q slower.obj -o slow >limits
! retex-import: error: slower.obj: not read within 300 s of processor time; --max-time allows more
= 2
$ sed 's/gigabytes [1-8]$/at most 8 GB/' limits
> seconds 301 at most 8 GB
$ limits limits retex-import --exposure 0 -q --max-time 40 --max-memory 1G slower.obj -o slow
> seconds 41 gigabytes 1
! retex-import: error: slower.obj: not read within 40 s of processor time; --max-time allows more
= 2
$ limits limits retex-import --exposure 0 -q --safe slower.obj -o slow
> seconds 61 gigabytes 2
! retex-import: error: slower.obj: not read within 60 s of processor time; --max-time allows more
= 2
$ ls -d slow*
> slow.obj
> slower.obj
