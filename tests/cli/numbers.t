# Numbers that are no colour: sets, packs and streams with NaN or infinity are refused by every reader, whole or row by
# row, and nothing is written; but depth may be infinite.
$ make_set s.exr 48 32; make_set nan.exr 48 32 t0_dep1=nan; retex-info nan.exr | head -1
> layout         paper
$ for command in 'retex-combine -q nan.exr -o x.exr' "retex-combine -q nan.exr --texture Floor=rgb(1,0,0) -o x.png" 'retex-pack -q nan.exr -o x.retex' 'retex-pack -q --lossless nan.exr -o x.retex' 'retex-info --check nan.exr' 'retex-combine -q - -o x.exr'; do $command <nan.exr; echo $?; done; ls x.*
> 2
> 2
> 2
> 2
> 1
> 2
! retex-combine: error: nan.exr: part t0_dep1 holds NaN at 5,3 in channel B: such values are refused
! retex-combine: error: nan.exr: part t0_dep1 holds NaN at 5,3 in channel B: such values are refused
! retex-pack: error: nan.exr: part t0_dep1 holds NaN at 5,3 in channel B: such values are refused
! retex-pack: error: nan.exr: part t0_dep1 holds NaN at 5,3 in channel B: such values are refused
! retex-info: error: nan.exr: part t0_dep1 holds NaN at 5,3 in channel B: such values are refused
! retex-combine: error: standard input: part t0_dep1 holds NaN at 5,3 in channel B: such values are refused
! ls: cannot access 'x.*': No such file or directory
= 2
$ for part in beauty t0_dep2 t0_uv1 t0_spread1 t0_albedo1 t1_dep1; do make_set nan.exr 48 32 $part=-inf; retex-pack -q --lossless nan.exr -o x.retex; done
! retex-pack: error: nan.exr: part beauty holds -infinity at 5,3 in channel B: such values are refused
! retex-pack: error: nan.exr: part t0_dep2 holds -infinity at 5,3 in channel B: such values are refused
! retex-pack: error: nan.exr: part t0_uv1 holds -infinity at 5,3 in channel A: such values are refused
! retex-pack: error: nan.exr: part t0_spread1 holds -infinity at 5,3 in channel G: such values are refused
! retex-pack: error: nan.exr: part t0_albedo1 holds -infinity at 5,3 in channel B: such values are refused
! retex-pack: error: nan.exr: part t1_dep1 holds -infinity at 5,3 in channel B: such values are refused
= 2
$ make_set inf.exr 48 32 depth=inf; retex-combine -q inf.exr -o y.exr; retex-pack -q --lossless inf.exr -o y.retex; retex-info --check inf.exr; retex-info --check y.retex
> inf.exr: ok
> y.retex: ok
$ make_set nan.exr 48 32 depth=nan; retex-info --check nan.exr
! retex-info: error: nan.exr: part depth holds NaN at 5,3 in channel R: such values are refused
= 1
$ make_set nan.exr 48 32 footprints denoise noise_indep=nan; retex-denoise -q nan.exr -o x.exr
! retex-denoise: error: nan.exr: part noise_indep holds NaN at 5,3 in channel B: such values are refused
= 2
$ make_set nan.exr 48 32 t0_dep1=nan; retex-diff nan.exr s.exr --part t0_dep1 --fail-psnr 1 | sed 's/.*: //'
> 1 samples are NaN or infinite
