# Completion of retex and its tools in bash. The tool that is called says itself what can stand at the cursor:
# tools/common/complete.c describes its answers.

# Sets retex_words to the words of the line up to the cursor. Readline also splits at =, : and @; what no blank separates
# is one word here.
_retex_read_line() {
    local line=${COMP_LINE:0:COMP_POINT} word rest i
    retex_words=()
    for ((i = 0; i <= COMP_CWORD; i++)); do
        word=${COMP_WORDS[i]}
        rest=${line#"${line%%[![:space:]]*}"}
        ((i < COMP_CWORD)) || word=${rest:0:${#word}}
        if ((i > 0)) && [[ $rest == "$line" && -n $line ]]; then
            retex_words[-1]+=$word
        else
            retex_words+=("$word")
        fi
        line=${rest:${#word}}
    done
}

# Prints a word as the shell would pass it, if that takes quotes and ~ only; else, as it is.
_retex_unquote() {
    local word=$1 open=$1
    case $word in
    \"*) open=${word#\"} open=${open//[^\"]/} && [[ -n $open ]] || word+=\" ;;
    \'*) open=${word#\'} open=${open//[^\']/} && [[ -n $open ]] || word+=\' ;;
    esac
    case $word in
    *[#\$\`\;\&\|\<\>\(\)\{\}\*\?\[\]!]* | *$'\n'*) printf '%s' "$1" ;;
    *) (eval "printf '%s' $word") 2>/dev/null || printf '%s' "$1" ;;
    esac
}

# Adds to COMPREPLY the files and folders that begin with $2 and end in one of the endings $3, after the text $1.
_retex_files() {
    local file ending
    while IFS= read -r file; do
        for ending in ${3:-''}; do
            if [[ -d ${file/#\~/$HOME} || ${file,,} == *."$ending" || $3 == '' ]]; then
                COMPREPLY+=("$1$file")
                break
            fi
        done
    done < <(compgen "$4" -- "$2")
    compopt -o filenames
}

_retex() {
    local retex_words=() words=() word rest line current strip breaks=${COMP_WORDBREAKS//[^=:@]/}
    COMPREPLY=()
    _retex_read_line
    for word in "${retex_words[@]}"; do
        words+=("$(_retex_unquote "$word")")
    done
    current=${words[-1]}
    # Readline replaces only what stands after the last of these.
    strip=
    [[ -z $breaks || $current != *["$breaks"]* ]] || strip=${current%"${current##*["$breaks"]}"}
    while IFS= read -r line; do
        word=${line%%$'\t'*} rest=${line#*$'\t'}
        case $word in
        :files | :folders)
            local before=${rest%%$'\t'*} endings=
            [[ $word == :folders ]] || endings=${rest#*$'\t'}
            _retex_files "${before#"$strip"}" "${current#"$before"}" "$endings" \
                "$([[ $word == :folders ]] && echo -d || echo -f)"
            ;;
        "$current"*)
            [[ $word != *' '* ]] || printf -v word %q "$word"
            COMPREPLY+=("${word#"$strip"}")
            ;;
        esac
    done < <("${words[0]}" --complete "${words[@]:1}" 2>/dev/null)
    if [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *= ]]; then
        compopt -o nospace
    fi
}

# This file also has the name of each tool, so that it is found by that.
# shellcheck disable=SC2046 # names of commands
complete -F _retex "${BASH_SOURCE[0]##*/}" $(compgen -c retex)
