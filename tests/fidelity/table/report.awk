# The table of `make fidelity` as Markdown: awk -f report.awk -v head=TEXT -v size=WxH -v truth=SAMPLES fidelity.csv
BEGIN { FS = "," }
NR == 1 { next }
{
    value[$1, $2, $3, $4] = $5
    if (!seen[$1]++) scene[++scenes] = $1
    if (!seen[$2]++) texture[++textures] = $2
    if (!seen["n" $3]++) count[++counts] = $3
    if ($4 != "again" && !seen["m" $4]++) method[++methods] = $4
}
function gap(s, t, n, m) { return value[s, t, n, m] - value[s, t, n, "again"] }
END {
    print "# Retexturing compared with rendering again"
    print ""
    print "Each scene was rendered again with new textures. Sets of the same number of samples and the same seed were retextured."
    print "The figures are PSNR in decibels (sRGB-encoded, clipped to 0..1) against converged pictures of " truth " samples, at"
    print size " pixels. `gap` is the PSNR of retexturing minus that of rendering again. Where it is above 0, retexturing gives"
    print "the better picture, because it filters textures where rendering samples them."
    print ""
    print "In scenes with two targets both change. The scenes are in `scenes/` and `tests/fidelity/scenes/`. The textures are those"
    print "of `make fidelity-textures`. [fidelity.csv](fidelity.csv) has the same figures."
    print head
    print ""
    print "| samples | set | mean gap | worst gap | where |"
    print "|---|---|---|---|---|"
    for (c = 1; c <= counts; c++)
        for (m = 1; m <= methods; m++) {
            sum = all = 0; worst = 1e9
            for (s = 1; s <= scenes; s++)
                for (t = 1; t <= textures; t++) {
                    if (!((scene[s], texture[t], count[c], method[m]) in value)) continue
                    g = gap(scene[s], texture[t], count[c], method[m])
                    sum += g; all++
                    if (g < worst) { worst = g; where = scene[s] ", " texture[t] }
                }
            if (all) printf "| %d | %s | %+.2f dB | %+.2f dB | %s |\n", count[c], method[m], sum / all, worst, where
        }
    print ""
    print "`footprints` has the default clusters, 4+2+8 per pixel and target; `footprints-8` has 8 of both kinds together"
    print "(`--clusters 8`). `paper-cross-2` leaves out the cross terms of three hits, `paper-cross-0` all cross terms"
    print "(`retex-combine --cross`)."
    print ""
    print "Mean gap by scene, and in brackets the mean PSNR of rendering again:"
    print ""
    line = "| scene |"; rule = "|---|"
    for (c = 1; c <= counts; c++) {
        line = line " footprints, " count[c] " | footprints-8 | paper |"
        rule = rule "---|---|---|"
    }
    print line "\n" rule
    split("footprints footprints-8 paper", column, " ")
    for (s = 1; s <= scenes; s++) {
        line = "| " scene[s] " |"
        for (c = 1; c <= counts; c++)
            for (m = 1; m <= 3; m++) {
                sum = all = again = 0
                for (t = 1; t <= textures; t++)
                    if ((scene[s], texture[t], count[c], column[m]) in value) {
                        sum += gap(scene[s], texture[t], count[c], column[m])
                        again += value[scene[s], texture[t], count[c], "again"]
                        all++
                    }
                line = line sprintf(m == 1 ? " %+.2f (%.1f) |" : " %+.2f |", sum / all, again / all)
            }
        print line
    }
    for (s = 1; s <= scenes; s++) {
        print "\n## " scene[s] "\n"
        line = "| texture |"; rule = "|---|"
        for (c = 1; c <= counts; c++) {
            line = line " again, " count[c] " | footprints | footprints-8 | paper |"
            rule = rule "---|---|---|---|"
        }
        print line "\n" rule
        for (t = 1; t <= textures; t++) {
            if (!((scene[s], texture[t], count[1], "again") in value)) continue
            line = "| " texture[t] " |"
            for (c = 1; c <= counts; c++) {
                line = line sprintf(" %.2f |", value[scene[s], texture[t], count[c], "again"])
                split("footprints footprints-8 paper", column, " ")
                for (m = 1; m <= 3; m++)
                    line = line sprintf(" %+.2f |", gap(scene[s], texture[t], count[c], column[m]))
            }
            print line
        }
    }
}
