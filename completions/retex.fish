# Completion of retex and its tools in fish. The tool that is called says itself what can stand at the cursor:
# tools/common/complete.c describes its answers. This file also has the name of each tool, by which fish finds it.

function __retex_complete
    set -l words (commandline -opc)
    set -l current (commandline -ct)
    set -l plain (string unescape -- $current; or echo -- $current)
    set -l program $words[1]
    set -e words[1]
    for line in ($program --complete $words "$plain" 2>/dev/null)
        set -l fields (string split \t -- $line)
        switch $fields[1]
            case :files :folders
                set -l start (string replace -- "$fields[2]" '' "$plain")
                set -l pattern (string replace -r '^~(?=/)' $HOME -- $start)
                for file in $pattern*
                    set -l name $fields[2](string replace -- "$pattern" "$start" $file)
                    if test -d $file
                        echo -- $name/
                    else if test $fields[1] = :files
                        set -l ending (string lower -- (string replace -r '.*\.' '' -- $file))
                        if test -z "$fields[3]"; or contains -- "$ending" (string split ' ' -- $fields[3])
                            echo -- $name
                        end
                    end
                end
            case '*'
                echo -- $line
        end
    end
end

complete -c (string replace -r '.*/(.*)\.fish$' '$1' -- (status filename)) -f -a '(__retex_complete)'
