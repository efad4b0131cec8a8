"""Completion of the words of `vcor` in bash, zsh and fish, from what `vcor help --json` says.

scripts/manual.py writes the files. The options of a program vcor-NAME of PATH come from its own --help.
"""

import re

MADE = "Made by scripts/manual.py from vcor help --json"
#: Longest description of an option
LONGEST = 70


def short(text):
    """The first clause of a description."""
    text = re.split(r"; |\. | \(", text.replace("`", ""))[0]
    return text if len(text) <= LONGEST else text[: text.rfind(",", 0, LONGEST)].rstrip(",")


def quoted(text):
    """A word of the shell."""
    return "'" + text.replace("'", "'\\''") + "'"


def options(command):
    """Options of a command: name, placeholder of its value (empty: none), description."""
    found = [
        (entry["option"], entry["value"], short(entry["text"]))
        for entry in command["page"]
        if "option" in entry
    ]
    return [*found, ("--help", "", "explain the command")]


def settings(document):
    """Addresses for --set, and words that they can be set to. Materials are known to the case only."""
    found = []
    for group in document["groups"]:
        if not group["repeated"]:
            for key in group["keys"]:
                address = f"{group['name']}.{key['name']}="
                found += [address + choice for choice in key["choices"]] or [address]
    return found


def topics(document):
    """Words that help explains."""
    keys = [key["name"] for group in document["groups"] for key in group["keys"]]
    names = [one["name"] for part in ("commands", "groups", "summary") for one in document[part]]
    return sorted({*names, *keys, "input", "output"})


def bash(document):
    cases = "\n".join(
        f"      {command['name']}) options={quoted(' '.join(o[0] for o in options(command)))} ;;"
        for command in document["commands"]
    )
    return f"""# {MADE}
declare -A _vcor_options=()

_vcor() {{
   local commands={quoted(" ".join(command["name"] for command in document["commands"]))}
   local line=${{COMP_LINE:0:COMP_POINT}} command=${{COMP_WORDS[1]}} word option options= kept= words=
   # the whole word before the cursor, which readline takes apart at = and :
   word=${{line##*[[:space:]]}}
   line=${{line%"$word"}}
   read -ra line <<<"$line"
   option=${{line[-1]}}
   if [ "${{#line[@]}}" -eq 1 ]; then
      words="$commands $(compgen -c vcor- | sed 's/^vcor-//')"
      mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
      return
   fi
   if [[ $word == --*=* ]]; then
      option=${{word%%=*}}
      word=${{word#*=}}
   fi
   case $command in
{cases}
      *)
         [ -n "${{_vcor_options[$command]}}" ] || _vcor_options[$command]="$(
            "vcor-$command" --help 2>/dev/null </dev/null | grep -oE -e '--[a-z][a-z-]*' | sort -u)"
         options=${{_vcor_options[$command]}} ;;
   esac
   case $option in
      --set) words={quoted(" ".join(settings(document)))} ;;
      --print | --quantity)
         words={quoted(" ".join(column["name"] for column in document["summary"]))}
         kept=${{word%"${{word##*,}}"}} ;;
      help) words={quoted(" ".join(topics(document)))} ;;
      *) [[ $word != -* ]] || words=$options ;;
   esac
   # no word is left: names of files
   mapfile -t COMPREPLY < <(compgen -P "$kept" -W "$words" -- "${{word#"$kept"}}")
   if [[ ${{COMPREPLY[0]}} == *= ]]; then compopt -o nospace 2>/dev/null; fi
   COMPREPLY=("${{COMPREPLY[@]#"${{word%"${{word##*[=:]}}"}}"}}")
}}
complete -o default -F _vcor vcor
"""


def zsh(document):
    def option_of(name, value, text):
        text = re.sub(r"([\[\]])", r"\\\1", text)
        actions = {"": "", "GROUP.KEY=VALUE": "_vcor_settings", "NAME,NAME": "_vcor_quantities"}
        action = actions.get(value, "_files")
        once = "*" if name in ("--set", "--fix", "--vary") else ""
        return quoted(f"{once}{name}" + (f"=[{text}]:{value}:{action}" if value else f"[{text}]"))

    cases = "\n".join(
        f"      {command['name']})\n         _arguments -S "
        + " \\\n            ".join(
            [*[option_of(*one) for one in options(command)],
             "'*:word:_vcor_topics'" if command["name"] == "help" else "'*:file:_files'"]
        )
        + " ;;"
        for command in document["commands"]
    )  # fmt: skip
    known = [*document["commands"], *document["package_commands"]]
    described = "\n".join(f"   {quoted(one['name'] + ':' + one['summary'])}" for one in known)
    columns = " ".join(quoted(column["name"]) for column in document["summary"])
    return f"""#compdef vcor
# {MADE}
_vcor_settings() {{
   compadd -S '' -- {" ".join(map(quoted, settings(document)))}
}}

_vcor_quantities() {{
   _values -s , quantity {columns}
}}

_vcor_topics() {{
   compadd -- {" ".join(topics(document))}
}}

_vcor() {{
   local -a known found
   known=(
{described}
   )
   if (( CURRENT == 2 )); then
      found=(${{${{(k)commands[(I)vcor-*]}}#vcor-}})
      known=(${{known[1,{len(document["commands"])}]}} ${{(M)known:#(${{(j:|:)~found}}):*}} $found)
      _describe command known
      return
   fi
   local command=$words[2]
   shift words
   (( CURRENT-- ))
   case $command in
{cases}
      *)
         _arguments '*:file:_files' \\
            ${{(u)${{(f)"$(vcor-$command --help 2>/dev/null </dev/null | grep -oE -e '--[a-z][a-z-]*')"}}}} ;;
   esac
}}

_vcor "$@"
"""


def fish(document):
    def name_and_summary(one):
        return quoted(f"{one['name']}\t{one['summary']}")

    names = " ".join(command["name"] for command in document["commands"])
    start = quoted(f"not __fish_seen_subcommand_from {names} (__vcor_programs)")
    lines = [
        f"# {MADE}",
        "function __vcor_programs",
        "   set -l found $PATH/vcor-*",
        "   path filter -fx -- $found | string replace -r '.*/vcor-' ''",
        "end",
        "function __vcor_described_programs",
        "   for name in (__vcor_programs)",
        "      switch $name",
        *[
            f"         case {one['name']}\n            echo {name_and_summary(one)}"
            for one in document["package_commands"]
        ],
        "         case '*'",
        "            echo $name",
        "      end",
        "   end",
        "end",
        "function __vcor_quantities",
        "   printf '%s\\n' " + " ".join(column["name"] for column in document["summary"]),
        "end",
        "function __vcor_options",
        "   set -l name (commandline -opc)[2]",
        "   command vcor-$name --help 2>/dev/null </dev/null | string match -ar -- '--[a-z][a-z-]*'",
        "end",
        f"complete -c vcor -n {start} -f -a '(__vcor_described_programs)'",
    ]
    for command in document["commands"]:
        name = command["name"]
        lines.append(f"complete -c vcor -n {start} -f -a {name} -d {quoted(command['summary'])}")
        within = f"complete -c vcor -n '__fish_seen_subcommand_from {name}'"
        for option, value, text in options(command):
            words = {
                "": "",
                "GROUP.KEY=VALUE": f" -x -a {quoted(' '.join(settings(document)))}",
                "NAME,NAME": " -x -a '(__fish_complete_list , __vcor_quantities)'",
            }.get(value, " -r")
            lines.append(f"{within} -l {option[2:]}{words} -d {quoted(text)}")
        if name == "help":
            lines.append(f"{within} -f -a {quoted(' '.join(topics(document)))}")
    lines.append(
        "complete -c vcor -n '__fish_seen_subcommand_from (__vcor_programs)' -a '(__vcor_options)'"
    )
    return "\n".join(lines) + "\n"


def files(document):
    """Text of each file by its path."""
    return {
        "completion/vcor.bash": bash(document),
        "completion/_vcor": zsh(document),
        "completion/vcor.fish": fish(document),
    }
