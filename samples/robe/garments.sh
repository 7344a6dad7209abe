# Run by samples/run.sh in this folder.
"$make_garments" /usr/share/assimp/models/BVH/01_01.bvh --kind skirt --waist 0.7 --flare 0.25 --length 1.0 --clearance 0.03 --rings 50 \
  --segments 90 --out robe.obj
