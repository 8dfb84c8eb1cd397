# Presses the tab key in zsh: zsh -f zsh_completion.zsh PROGRAM LINE...
# Prints, for each command line, the matches that zsh lists for it, and the line after the completion: "[line]".
export TERM=dumb
zmodload zsh/zpty
script=$(mktemp -d)
trap 'rm -rf $script' EXIT
$1 completion zsh > $script/_pkmopt
zpty shell zsh -f -i
zpty -w shell "fpath=(${(q)script} \$fpath) PATH=${(q)1:h}:\$PATH LISTMAX=0 PROMPT= RPROMPT="
zpty -w shell 'autoload -Uz compinit; compinit -D -u; unsetopt beep'
zpty -w shell 'show() { zle -I; print -r -- "[$BUFFER]E""ND"; BUFFER= }; zle -N show; bindkey "^X" show'
for line in "${@[2,-1]}"; do
  zpty -w -n shell "$line"$'\t\x18'
  zpty -r shell output '*END*'
  print -r -- "$output"
done
zpty -d shell
