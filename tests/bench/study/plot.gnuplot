# gnuplot -e "tables='FOLDER'" plot.gnuplot: from the tables of tests/bench/study/run to docs/images
scenes = "walls planes office dunes"
set terminal svg size 860,620 font "sans,13" background "white"
set key bottom right samplen 1
set grid

set output "docs/images/sampling_ablation.svg"
set multiplot layout 2,2 title "Crossings found within 10 us, by cost"
set logscale x
set xrange [0.5:30000]
set yrange [0:1.2]
set xlabel "rays per event"
set ylabel "recall at 10 us"
do for [scene in scenes] {
  table = tables."/ablation_".scene.".txt"
  set title scene
  plot table using 4:(stringcolumn(1) eq "frames" ? $6 : NaN) with linespoints lw 2 pt 7 lc rgb "#c05020" title "frames", \
    table using (stringcolumn(1) eq "frames" ? $4 : NaN):($6 + 0.06):(sprintf("%g", $2)) with labels font ",9" notitle, \
    table using 4:(stringcolumn(1) eq "asynchronous" ? $6 : NaN) with points pt 5 ps 1.3 lc rgb "#2060a0" title "asynchronous"
}
unset multiplot

set terminal svg size 860,330 font "sans,13" background "white"
set output "docs/images/simulation_growth.svg"
set multiplot layout 1,2
set format x "10^{%T}"
unset key
set key bottom right maxrows 4
set yrange [1e-6:1000]
set format y "10^{%T}"
set logscale y
set xrange [1e4:1e7]
set title "Walls: pixels"
set xlabel "pixels"
set ylabel "millions per processor second"
rates = "11 12 13 14"
names = "events 'rays of the simulation' 'rays of Scene::visible' 'rays of Embree alone'"
plot for [i=1:4] tables."/resolution.txt" using ($1**2 * ($1 == 1280 ? 0.5625 : 0.75)):(column(int(word(rates, i)))) with linespoints lw 2 pt 7 title word(names, i)
set title "Dunes: triangles"
set xlabel "triangles"
set xrange [100:1e7]
plot for [i=1:4] tables."/triangles.txt" using 2:(column(int(word(rates, i)))) with linespoints lw 2 pt 7 title word(names, i)
unset multiplot
