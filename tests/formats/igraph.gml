Creator "c"
Version 1
graph
[
  directed 0
  node
  [
    id 0
    x 0
    y 0
    z 0
    label "p<0>"
  ]
  node
  [
    id 1
    x 12.5
    y 0
    z 3.75
    label "p<1>"
  ]
  node
  [
    id 2
    x 25
    y 0
    z 5
    label "p<2>"
  ]
  node
  [
    id 3
    x 37.5
    y 0
    z 3.75
    label "p<3>"
  ]
  node
  [
    id 4
    x 50
    y 0
    z 0
    label "p<4>"
  ]
  node
  [
    id 5
    x 0
    y 10
    z 0
    label "p<5>"
  ]
  node
  [
    id 6
    x 12.5
    y 10
    z 3.75
    label "p<6>"
  ]
  node
  [
    id 7
    x 25
    y 10
    z 5
    label "p<7>"
  ]
  node
  [
    id 8
    x 37.5
    y 10
    z 3.75
    label "p<8>"
  ]
  node
  [
    id 9
    x 50
    y 10
    z 0
    label "p<9>"
  ]
  node
  [
    id 10
    x 0
    y 20
    z 0
    label "p<10>"
  ]
  node
  [
    id 11
    x 12.5
    y 20
    z 3.75
    label "p<11>"
  ]
  node
  [
    id 12
    x 25
    y 20
    z 5
    label "p<12>"
  ]
  node
  [
    id 13
    x 37.5
    y 20
    z 3.75
    label "p<13>"
  ]
  node
  [
    id 14
    x 50
    y 20
    z 0
    label "p<14>"
  ]
  node
  [
    id 15
    x 0
    y 30
    z 0
    label "p<15>"
  ]
  node
  [
    id 16
    x 12.5
    y 30
    z 3.75
    label "p<16>"
  ]
  node
  [
    id 17
    x 25
    y 30
    z 5
    label "p<17>"
  ]
  node
  [
    id 18
    x 37.5
    y 30
    z 3.75
    label "p<18>"
  ]
  node
  [
    id 19
    x 50
    y 30
    z 0
    label "p<19>"
  ]
  edge
  [
    source 1
    target 0
  ]
  edge
  [
    source 5
    target 0
  ]
  edge
  [
    source 2
    target 1
  ]
  edge
  [
    source 6
    target 1
  ]
  edge
  [
    source 3
    target 2
  ]
  edge
  [
    source 7
    target 2
  ]
  edge
  [
    source 4
    target 3
  ]
  edge
  [
    source 8
    target 3
  ]
  edge
  [
    source 9
    target 4
  ]
  edge
  [
    source 6
    target 5
  ]
  edge
  [
    source 10
    target 5
  ]
  edge
  [
    source 7
    target 6
  ]
  edge
  [
    source 11
    target 6
  ]
  edge
  [
    source 8
    target 7
  ]
  edge
  [
    source 12
    target 7
  ]
  edge
  [
    source 9
    target 8
  ]
  edge
  [
    source 13
    target 8
  ]
  edge
  [
    source 14
    target 9
  ]
  edge
  [
    source 11
    target 10
  ]
  edge
  [
    source 15
    target 10
  ]
  edge
  [
    source 12
    target 11
  ]
  edge
  [
    source 16
    target 11
  ]
  edge
  [
    source 13
    target 12
  ]
  edge
  [
    source 17
    target 12
  ]
  edge
  [
    source 14
    target 13
  ]
  edge
  [
    source 18
    target 13
  ]
  edge
  [
    source 19
    target 14
  ]
  edge
  [
    source 16
    target 15
  ]
  edge
  [
    source 17
    target 16
  ]
  edge
  [
    source 18
    target 17
  ]
  edge
  [
    source 19
    target 18
  ]
]
