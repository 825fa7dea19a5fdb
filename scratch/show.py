import collections,sys
L=[l.rstrip("\n").split(" ; ") for l in open(sys.argv[1]) if " ; " in l]
c=collections.defaultdict(list)
for l in L: c[(l[0],l[1],l[3])].append((l[2], l[4] if len(l)>4 else ""))
for k,v in c.items(): print(k, len(v), "::", ", ".join(a for a,_ in v)[:150], "::", v[0][1][:100])
