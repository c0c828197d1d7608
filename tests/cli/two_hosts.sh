#!/bin/sh
# two_hosts.sh COMMAND...: one MPI rank of the command on each of two hosts, as far as one machine can be two: network
# namespaces with a name of their own, joined by a cable, that see nothing else. Exit 77: this machine does not allow it.
set -u
id=$$
a=vsssa$id b=vsssb$id
clean() {
  ip netns del "$a" 2>/dev/null
  ip netns del "$b" 2>/dev/null
  rm -f "$agent"
}
agent=$(mktemp /tmp/vsss_agent_XXXXXX)
trap clean EXIT
trap 'exit 1' INT TERM
for tool in ip unshare mpirun; do command -v $tool >/dev/null || { echo "no $tool"; exit 77; }; done
{
  ip netns add "$a" && ip netns add "$b" &&
    ip link add name "$a" netns "$a" type veth peer name "$b" netns "$b" &&
    ip -n "$a" addr add 10.213.7.1/30 dev "$a" && ip -n "$b" addr add 10.213.7.2/30 dev "$b" &&
    ip -n "$a" link set "$a" up && ip -n "$b" link set "$b" up &&
    ip -n "$a" link set lo up && ip -n "$b" link set lo up
} 2>/dev/null || { echo "no network namespaces"; exit 77; }
# What mpirun takes for ssh: it is given the host's address, then the command to run there.
cat >"$agent" <<END
#!/bin/sh
while [ "\${1#-}" != "\$1" ]; do shift; done
shift
exec ip netns exec $b unshare --uts sh -c "hostname vsss-b; \$*"
END
chmod 700 "$agent"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_plm_rsh_agent="$agent" PRTE_MCA_plm_ssh_agent="$agent"
export OMPI_MCA_btl=self,tcp OMPI_MCA_pml=ob1
on_both() {
  ip netns exec "$a" unshare --uts sh -c 'hostname vsss-a && exec "$@"' sh \
    timeout 120 mpirun --host 10.213.7.1:1,10.213.7.2:1 -n 2 "$@" </dev/null
}
on_both true >/dev/null 2>&1 || { echo "mpirun starts nothing across network namespaces"; exit 77; }
on_both "$@"
